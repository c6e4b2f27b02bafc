/* Prints the completion scripts for bash, zsh and fish from the table of options, so that they offer exactly what the
 * parser accepts.
 *
 * The script for bash consists of three tables and a function. The tables are shell functions: the options of a verb,
 * the values of an option, and the operands of a verb. The function determines what kind of word is at the cursor, and
 * looks up the candidates in the tables. In the tables, the words @files and @folders stand for paths.
 *
 * The script for zsh has one call of _arguments for each verb; zsh does the rest. The script for fish has one call of
 * complete for each option of each verb. */
#include "cli/completion.h"

#include "cli/options_table.h"

#include <string.h>

static const char style_actions[] = "check eval", tiles_actions[] = "show verify merge";

/* The names of the styles that ship with camber. */
static void print_styles(FILE *file) {
#ifdef CAMBER_MAP
    const char *name;
    for (size_t i = 0; (name = camber_style_list(i)) != NULL; i++)
        fprintf(file, "%s%s", i ? " " : "", name);
#else
    (void)file;
#endif
}

static void print_verbs(FILE *file) {
    for (size_t i = 0; i < camber_verb_count; i++)
        fprintf(file, "%s ", camber_verb_specs[i].name);
    fputs("help version", file);
}

/* The words of a choice, a|b|c, with blanks between them. */
static void print_choice(const char *words, FILE *file) {
    for (; *words; words++)
        fputc(*words == '|' ? ' ' : *words, file);
}

static bool takes_files(const camber_verb_spec *verb) {
    return strstr(verb->operands, "INPUT") != NULL && verb->verb != CAMBER_VERB_TILES;
}

/* Whether the completion for a verb offers an option: those that its help lists. */
static bool is_offered(const camber_option_spec *spec, camber_verb verb) {
    return spec->verbs & 1 << verb && *camber_option_help(spec, verb);
}

/* ---- bash ---- */

static void print_bash_options(const char *name, camber_verb verb, FILE *file) {
    fprintf(file, "    %s) echo '", name);
    for (size_t i = 0; i < camber_option_count; i++) {
        const camber_option_spec *spec = &camber_option_specs[i];
        if (is_offered(spec, verb) && spec->letter)
            fprintf(file, "-%c ", spec->letter);
        if (is_offered(spec, verb))
            fprintf(file, "--%s ", spec->name);
    }
    fputs("' ;;\n", file);
}

static void print_bash_value(const camber_option_spec *spec, FILE *file) {
    if (!spec->argument)
        return;
    fputs("    ", file);
    if (spec->letter)
        fprintf(file, "-%c | ", spec->letter);
    fprintf(file, "--%s) echo '", spec->name);
    switch (spec->kind) {
    case CAMBER_OPTION_FILE: fputs("@files", file); break;
    case CAMBER_OPTION_FOLDER:
    case CAMBER_OPTION_FONTS: fputs("@folders", file); break;
    case CAMBER_OPTION_STYLE:
        fputs("@files ", file);
        print_styles(file);
        break;
    case CAMBER_OPTION_DEVICE: fputs("cpu gpu", file); break;
    case CAMBER_OPTION_CHOICE: print_choice(spec->argument, file); break;
    default: break; /* numbers and texts cannot be completed */
    }
    fputs("' ;;\n", file);
}

static void print_bash_operands(FILE *file) {
    for (size_t i = 0; i < camber_verb_count; i++)
        if (takes_files(&camber_verb_specs[i]))
            fprintf(file, "    %s:*) echo '@files' ;;\n", camber_verb_specs[i].name);
#ifdef CAMBER_MAP
    fprintf(file, "    style:) echo '%s' ;;\n    style:check) echo '@files ", style_actions);
    print_styles(file);
    fprintf(file,
            "' ;;\n    style:*) echo '@files' ;;\n    tiles:) echo '@files %s' ;;\n    tiles:*) echo '@files' ;;\n",
            tiles_actions);
#endif
    fputs("    : | help:) echo '", file);
    print_verbs(file);
    fputs("' ;;\n", file);
}

static const char bash_function[] =
    "_camber() {\n"
    "    local word option='' verb='' operand='' only_operands='' words kind='' at\n"
    "    for ((at = 1; at < COMP_CWORD; at++)); do\n"
    "        word=${COMP_WORDS[at]}\n"
    "        if [[ $only_operands || $word != -?* ]]; then\n"
    "            if [[ ! $verb ]]; then verb=$word; elif [[ ! $operand ]]; then operand=$word; fi\n"
    "        elif [[ $word == -- ]]; then\n"
    "            only_operands=yes\n"
    "        elif _camber_value \"$word\" >/dev/null; then\n"
    "            # The value is the next word. To bash --option=value is three words.\n"
    "            [[ ${COMP_WORDS[at + 1]} != = ]] || ((at += 1))\n"
    "            ((at += 1))\n"
    "            ((at < COMP_CWORD)) || option=$word\n"
    "        fi\n"
    "    done\n"
    "    word=${COMP_WORDS[COMP_CWORD]}\n"
    "    [[ $word != = ]] || word=\n"
    "    if [[ $option ]]; then\n"
    "        words=$(_camber_value \"$option\")\n"
    "    elif [[ $word == -* && ! $only_operands ]]; then\n"
    "        words=$(_camber_options \"$verb\")\n"
    "    else\n"
    "        words=$(_camber_operands \"$verb:$operand\")\n"
    "    fi\n"
    "    case $words in\n"
    "    *@files*) kind=-f words=${words/@files/} ;;\n"
    "    *@folders*) kind=-d words=${words/@folders/} ;;\n"
    "    esac\n"
    "    mapfile -t COMPREPLY < <(\n"
    "        compgen -W \"$words\" -- \"$word\"\n"
    "        [[ ! $kind ]] || compgen $kind -- \"$word\"\n"
    "    )\n"
    "    [[ ! $kind ]] || compopt -o filenames 2>/dev/null\n"
    "}\n"
    "complete -F _camber camber\n";

static void print_bash(FILE *file) {
    fputs("# bash completion of camber; made by `camber --completion bash`.\n\n"
          "# The options of a verb; without one, those of camber itself.\n"
          "_camber_options() {\n    case $1 in\n",
          file);
    for (size_t i = 0; i < camber_verb_count; i++)
        print_bash_options(camber_verb_specs[i].name, camber_verb_specs[i].verb, file);
    print_bash_options("*", CAMBER_VERB_NONE, file);
    fputs("    esac\n}\n\n# The values of an option; status 1 if it takes none.\n_camber_value() {\n    case $1 in\n",
          file);
    for (size_t i = 0; i < camber_option_count; i++)
        print_bash_value(&camber_option_specs[i], file);
    fputs("    *) return 1 ;;\n    esac\n}\n\n# The operands that may follow VERB:OPERAND.\n_camber_operands() {\n    "
          "case $1 "
          "in\n",
          file);
    print_bash_operands(file);
    fputs("    esac\n}\n\n", file);
    fputs(bash_function, file);
}

/* ---- zsh ---- */

/* Escapes text for single quotes in a description of _arguments or _describe. */
static void print_escaped(const char *text, FILE *file) {
    for (; *text; text++)
        switch (*text) {
        case '\'': fputs("'\\''", file); break;
        case '[':
        case ']':
        case ':':
        case '\\': fprintf(file, "\\%c", *text); break;
        default: fputc(*text, file);
        }
}

/* Prints the action with which zsh completes an option's value. */
static void print_zsh_value(const camber_option_spec *spec, camber_verb verb, FILE *file) {
    const char *argument = camber_option_argument(spec, verb);
    if (!argument)
        return;
    fputc(':', file);
    print_escaped(argument, file);
    fputc(':', file);
    switch (spec->kind) {
    case CAMBER_OPTION_FILE: fputs("_files", file); break;
    case CAMBER_OPTION_FOLDER:
    case CAMBER_OPTION_FONTS: fputs("_files -/", file); break;
    case CAMBER_OPTION_STYLE: fputs("_camber_styles", file); break;
    case CAMBER_OPTION_DEVICE: fputs("(cpu gpu)", file); break;
    case CAMBER_OPTION_CHOICE:
        fputc('(', file);
        print_choice(argument, file);
        fputc(')', file);
        break;
    default: break;
    }
}

/* Prints, for example, '(-o --output)'{-o+,--output=}'[file to write]:OUT:_files'. */
static void print_zsh_option(const camber_option_spec *spec, camber_verb verb, FILE *file) {
    const char *name = spec->name, *is = spec->argument ? "=" : "";
    fputs(" \\\n            ", file);
    if (spec->letter)
        fprintf(file, "'(-%c --%s)'{-%c%s,--%s%s}'[", spec->letter, name, spec->letter, spec->argument ? "+" : "", name,
                is);
    else
        fprintf(file, "'%s--%s%s[", camber_option_repeats(spec) ? "*" : "", name, is);
    print_escaped(camber_option_help(spec, verb), file);
    fputc(']', file);
    print_zsh_value(spec, verb, file);
    fputc('\'', file);
}

static void print_zsh_options(camber_verb verb, FILE *file) {
    for (size_t i = 0; i < camber_option_count; i++)
        if (is_offered(&camber_option_specs[i], verb))
            print_zsh_option(&camber_option_specs[i], verb, file);
}

static void print_zsh_verb(const camber_verb_spec *verb, FILE *file) {
    fprintf(file, "    %s)\n        _arguments -s -S", verb->name);
    print_zsh_options(verb->verb, file);
    if (takes_files(verb))
        fputs(" \\\n            '*:INPUT:_files'", file);
    if (verb->verb == CAMBER_VERB_STYLE)
        fprintf(file, " \\\n            '1:action:(%s)' '2:style:_camber_styles'", style_actions);
    if (verb->verb == CAMBER_VERB_TILES)
        fprintf(file, " \\\n            '1: :_alternative \"actions:action:(%s)\" files:INPUT:_files' '*:file:_files'",
                tiles_actions);
    fputs("\n        ;;\n", file);
}

static void print_zsh(FILE *file) {
    fputs("#compdef camber\n# zsh completion of camber; made by `camber --completion zsh`.\n\n"
          "_camber_verbs() {\n    local -a verbs=(",
          file);
    for (size_t i = 0; i < camber_verb_count; i++) {
        fprintf(file, "\n        '%s:", camber_verb_specs[i].name);
        print_escaped(camber_verb_specs[i].summary, file);
        fputc('\'', file);
    }
    fputs("\n        'help:print the help of camber or of a verb'\n        'version:print the version'\n    )\n"
          "    _describe verb verbs\n}\n\n_camber_styles() {\n    _alternative 'styles:built-in style:(",
          file);
    print_styles(file);
    fputs(")' 'files:style document:_files'\n}\n\n"
          "_camber() {\n    local curcontext=$curcontext state line\n    typeset -A opt_args\n    _arguments -s -S -C",
          file);
    print_zsh_options(CAMBER_VERB_NONE, file);
    fputs(" \\\n            '1: :_camber_verbs' '*:: :->operands' && return\n    case $words[1] in\n", file);
    for (size_t i = 0; i < camber_verb_count; i++)
        print_zsh_verb(&camber_verb_specs[i], file);
    fputs("    help) _arguments '1: :_camber_verbs' ;;\n    esac\n}\n\n"
          "# The shell runs this file as the function _camber, or a user sources it.\n"
          "if [[ $funcstack[1] == _camber ]]; then _camber \"$@\"; else compdef _camber camber; fi\n",
          file);
}

/* ---- fish ---- */

/* In single quotes fish reads a backslash only before another or a quote. */
static void print_quoted(const char *text, FILE *file) {
    fputc('\'', file);
    for (; *text; text++) {
        if (*text == '\'' || *text == '\\')
            fputc('\\', file);
        fputc(*text, file);
    }
    fputc('\'', file);
}

/* Prints how fish completes an option's value: -x takes only the words of -a, -r also files. */
static void print_fish_value(const camber_option_spec *spec, camber_verb verb, FILE *file) {
    switch (spec->kind) {
    case CAMBER_OPTION_FILE: fputs(" -r -F", file); break;
    case CAMBER_OPTION_FOLDER:
    case CAMBER_OPTION_FONTS: fputs(" -x -a '(__fish_complete_directories)'", file); break;
    case CAMBER_OPTION_STYLE:
        fputs(" -r -F -a '", file);
        print_styles(file);
        fputc('\'', file);
        break;
    case CAMBER_OPTION_DEVICE: fputs(" -x -a 'cpu gpu'", file); break;
    case CAMBER_OPTION_CHOICE:
        fputs(" -x -a '", file);
        print_choice(camber_option_argument(spec, verb), file);
        fputc('\'', file);
        break;
    default: fputs(" -x", file); break;
    }
}

/* when: the condition under which fish offers them. */
static void print_fish_options(const char *when, camber_verb verb, FILE *file) {
    for (size_t i = 0; i < camber_option_count; i++) {
        const camber_option_spec *spec = &camber_option_specs[i];
        if (!is_offered(spec, verb))
            continue;
        fprintf(file, "complete -c camber -n '%s' -l %s", when, spec->name);
        if (spec->letter)
            fprintf(file, " -s %c", spec->letter);
        if (spec->argument)
            print_fish_value(spec, verb, file);
        fputs(" -d ", file);
        print_quoted(camber_option_help(spec, verb), file);
        fputc('\n', file);
    }
}

static void print_fish_operands(const camber_verb_spec *verb, const char *when, FILE *file) {
    const bool tiles = verb->verb == CAMBER_VERB_TILES;
    if (takes_files(verb) || tiles)
        fprintf(file, "complete -c camber -n '%s' -F\n", when);
    if (tiles)
        fprintf(file, "complete -c camber -n '%s; and not __fish_seen_subcommand_from %s' -a '%s'\n", when,
                tiles_actions, tiles_actions);
    if (verb->verb != CAMBER_VERB_STYLE)
        return;
    fprintf(file, "complete -c camber -n '%s; and not __fish_seen_subcommand_from %s' -f -a '%s'\n", when,
            style_actions, style_actions);
    fprintf(file, "complete -c camber -n '%s; and __fish_seen_subcommand_from %s' -F\n", when, style_actions);
    fprintf(file, "complete -c camber -n '%s; and __fish_seen_subcommand_from check' -a '", when);
    print_styles(file);
    fputs("'\n", file);
}

static void print_fish(FILE *file) {
    fputs("# fish completion of camber; made by `camber --completion fish`.\n\n"
          "# The first word that is no option; status 1 if there is none yet.\n"
          "function __camber_verb\n"
          "    for word in (commandline -opc)[2..-1]\n"
          "        string match -q -- '-*' $word; and continue\n"
          "        echo $word\n"
          "        return 0\n"
          "    end\n"
          "    return 1\n"
          "end\n\n"
          "function __camber_in\n    test (__camber_verb; or echo) = $argv[1]\nend\n\ncomplete -c camber -f\n",
          file);
    const char *const begin = "not __camber_verb >/dev/null";
    print_fish_options(begin, CAMBER_VERB_NONE, file);
    fprintf(file, "complete -c camber -n '%s' -a help -d 'print the help of camber or of a verb'\n", begin);
    fprintf(file, "complete -c camber -n '%s' -a version -d 'print the version'\n", begin);
    for (size_t i = 0; i < camber_verb_count; i++) {
        const camber_verb_spec *verb = &camber_verb_specs[i];
        char when[64];
        fprintf(file, "complete -c camber -n '%s' -a %s -d ", begin, verb->name);
        print_quoted(verb->summary, file);
        fprintf(file, "\ncomplete -c camber -n '__camber_in help' -a %s -d ", verb->name);
        print_quoted(verb->summary, file);
        fputc('\n', file);
        snprintf(when, sizeof when, "__camber_in %s", verb->name);
        print_fish_operands(verb, when, file);
        print_fish_options(when, verb->verb, file);
    }
}

void camber_completion_print(camber_shell shell, FILE *file) {
    switch (shell) {
    case CAMBER_SHELL_BASH: print_bash(file); break;
    case CAMBER_SHELL_ZSH: print_zsh(file); break;
    case CAMBER_SHELL_FISH: print_fish(file); break;
    }
}
