#!/usr/bin/env python3
"""Completion in bash, fish and zsh: the shells offer what --help lists, and files where files are read.

    test_completion.py CAMBER

In bash the function is called as bash calls it; fish is asked what it would complete. In zsh a completion is asked for
in a terminal, and the list that zsh shows is read. Exits with 77, and a reason, where there is no fish or no zsh; the
others have been tested by then.
"""

import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

tool = os.path.abspath(sys.argv[1])
folder = tempfile.mkdtemp()
failures = []

BASH = r"""
source completion.bash
COMP_WORDS=("$@")
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
complete -p camber >/dev/null || exit 3
_camber
printf '%s\n' "${COMPREPLY[@]}"
"""

# Control-X lists what zsh offers: words alone, without their descriptions.
ZSH = r"""
PS1=; fpath=($PWD/site $fpath); autoload -Uz compinit; compinit -u -d $PWD/dump
stty cols 200 rows 100
KEYTIMEOUT=1 LISTMAX=10000; setopt no_beep no_list_beep no_list_types no_list_ambiguous
zstyle ':completion:*' verbose no
zstyle ':completion:*' list-separator ''
finish() { zle list-choices; zle -R; print; print -r -- '<<'end'>>'; zle kill-whole-line }
zle -N finish; bindkey '^X' finish
print set up
"""


def check(shell, words, has, lacks, found):
    """words is a command line, and its last word is to be completed."""
    missing = [word for word in has if word not in found]
    wrong = [word for word in lacks if word in found]
    if missing or wrong:
        failures.append("%s: %s: misses %s, offers %s: %s" % (shell, words, missing, wrong, sorted(found)))


def complete_in_bash(words):
    run = subprocess.run(["bash", "-c", BASH, "bash", *words], cwd=folder, capture_output=True, text=True)
    if run.returncode or run.stderr:
        failures.append("bash: %s: status %d: %s" % (words, run.returncode, run.stderr))
    return set(run.stdout.split("\n")) - {""}


def complete_in_fish(words):
    """fish lists options that begin with a dash only where the word does."""
    line = " ".join(words)
    run = subprocess.run(["fish", "--no-config", "-c", "source completion.fish; complete -C $argv[1]", line], cwd=folder,
                         capture_output=True, text=True)
    if run.returncode or run.stderr:
        failures.append("fish: %s: status %d: %s" % (words, run.returncode, run.stderr))
    return {line.split("\t")[0].replace("\\ ", " ") for line in run.stdout.split("\n")} - {""}


class Zsh:
    """An interactive zsh in a terminal of its own."""

    def __init__(self):
        os.makedirs(os.path.join(folder, "site"))
        shutil.copy(os.path.join(folder, "completion.zsh"), os.path.join(folder, "site/_camber"))
        with open(os.path.join(folder, "setup.zsh"), "w") as file:
            file.write(ZSH)
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.chdir(folder)
            os.environ["TERM"] = "dumb"
            os.execlp("zsh", "zsh", "-f", "-i")
        self.ask("source ./setup.zsh\n", "\nset up")

    def ask(self, text, end):
        os.write(self.terminal, text.encode())
        got, until = "", time.monotonic() + 300  # seconds, which only a hang takes
        while end not in got and time.monotonic() < until:
            if select.select([self.terminal], [], [], 0.5)[0]:
                got += os.read(self.terminal, 65536).decode(errors="replace")
        return got

    def complete(self, words):
        shown = self.ask(" ".join(words) + "\x18", "<<end>>")
        if "<<end>>" not in shown:
            failures.append("zsh: %s: no answer: %r" % (words, shown))
        listed = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", " ", shown).split("<<end>>")[0]
        return set(listed.split()) - set(words[:-1])

    def close(self):
        os.write(self.terminal, b"exit\n")
        os.close(self.terminal)
        os.waitpid(self.process, 0)


def options_of(verb):
    """The long options that the help of a verb lists."""
    text = subprocess.run([tool, verb, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^  (?:-\w, |    )(--[a-z-]+)", text, re.M))


def cases():
    """(words, what is offered, what is not)"""
    verbs = ["render", "tessellate", "compare", "validate", "bench", "style", "info", "help", "version"]
    yield ["camber", ""], verbs, ["roads.gpkg", "png"]
    yield ["camber", "te"], ["tessellate"], ["render"]
    yield ["camber", "help", ""], ["render", "bench"], ["roads.gpkg"]
    yield ["camber", "render", ""], ["roads.gpkg", "two words.json"], ["render", "--size"]
    yield ["camber", "render", "--format", ""], ["png", "png8", "webp"], ["roads.gpkg"]
    yield ["camber", "render", "--format", "p"], ["png", "png8"], ["glb"]
    yield ["camber", "render", "roads.gpkg", "--method", ""], ["strip", "kite", "fan"], ["roads.gpkg"]
    yield ["camber", "validate", "--backend", ""], ["auto", "egl", "osmesa"], ["gl"]
    yield ["camber", "bench", "--draw", ""], ["auto", "gl", "cl"], []
    yield ["camber", "render", "--theme", "d"], ["dark"], ["light"]
    yield ["camber", "info", "--device", ""], ["cpu", "gpu"], []
    yield ["camber", "render", "--style", ""], ["city", "roads", "transit", "openmaptiles", "roads.gpkg"], ["check"]
    yield ["camber", "render", "--size", ""], [], ["roads.gpkg", "png"]
    yield ["camber", "render", "-o", ""], ["roads.gpkg"], []
    yield ["camber", "style", ""], ["check", "eval"], ["roads.gpkg"]
    yield ["camber", "style", "check", ""], ["transit", "roads.gpkg"], ["eval"]
    yield ["camber", "render", "--", ""], ["roads.gpkg"], ["--size"]
    yield ["camber", "--completion", ""], ["bash", "fish", "zsh"], []
    yield ["camber", "tiles", ""], ["show", "verify", "merge", "roads.gpkg"], []


def main():
    for shell in ("bash", "fish", "zsh"):
        text = subprocess.run([tool, "--completion", shell], capture_output=True, text=True, check=True).stdout
        with open(os.path.join(folder, "completion." + shell), "w") as file:
            file.write(text)
    for name in ("roads.gpkg", "two words.json"):
        open(os.path.join(folder, name), "w").close()
    os.makedirs(os.path.join(folder, "a_folder"))
    for words, has, lacks in cases():
        check("bash", words, has, lacks, complete_in_bash(words))
    # To bash an = is a word of its own.
    check("bash", "--format=", ["png", "glb"], ["roads.gpkg"], complete_in_bash(["camber", "render", "--format", "="]))
    check("bash", "--format=p", ["png", "png8"], ["glb"], complete_in_bash(["camber", "render", "--format", "=", "p"]))
    check("bash", "--root", ["a_folder"], ["roads.gpkg"], complete_in_bash(["camber", "render", "--root", ""]))
    for verb in ("render", "tessellate", "compare", "validate", "bench", "info", "style"):
        wanted, found = options_of(verb), complete_in_bash(["camber", verb, "--"])
        if wanted != found:
            failures.append("bash: options of %s: %s" % (verb, sorted(wanted ^ found)))
    reasons = []
    if shutil.which("fish"):
        test_fish()
    else:
        reasons.append("no fish here (Debian: fish)")
    if not shutil.which("zsh"):
        reasons.append("no zsh here (Debian: zsh)")
    elif not has_terminals():
        reasons.append("no terminals here (/dev/pts) for zsh")
    else:
        test_zsh()
    reason = "; ".join(reasons)
    for failure in failures:
        print(failure)
    if failures:
        return 1
    if reason:
        print(reason + "; the others passed")
    return 77 if reason else 0


def has_terminals():
    """A system in a folder may be without them."""
    try:
        for end in os.openpty():
            os.close(end)
    except OSError:
        return False
    return True


def test_fish():
    for words, has, lacks in cases():
        check("fish", words, has, lacks, complete_in_fish(words))
    check("fish", "--format=", ["--format=png", "--format=webp"], ["--format=glb"],
          complete_in_fish(["camber", "render", "--format="]))
    check("fish", "--root", ["a_folder/"], ["roads.gpkg"], complete_in_fish(["camber", "render", "--root", ""]))
    for verb in ("render", "tessellate", "compare", "validate", "bench", "info", "style", "tiles", "serve"):
        wanted, found = options_of(verb), {word for word in complete_in_fish(["camber", verb, "--"])}
        if wanted != found:
            failures.append("fish: options of %s: %s" % (verb, sorted(wanted ^ found)))


def test_zsh():
    zsh = Zsh()
    for words, has, lacks in cases():
        check("zsh", words, [word.split()[-1] for word in has], lacks, zsh.complete(words))
    check("zsh", "--format=", ["png", "webp"], ["roads.gpkg", "glb"], zsh.complete(["camber", "render", "--format="]))
    check("zsh", "--root", [], ["roads.gpkg"], zsh.complete(["camber", "render", "--root", ""]))
    for verb in ("render", "compare", "validate", "info"):
        found = {word.rstrip("=") for word in zsh.complete(["camber", verb, "--"])}
        check("zsh", "options of " + verb, options_of(verb) - {"--help", "--version"}, ["--completion"], found)
    zsh.close()


try:
    status = main()
finally:
    shutil.rmtree(folder)
sys.exit(status)
