#!/bin/sh
# ccache knows no OpenCL C. Compiles an object, or copies the one that this compiler made of the same text before:
#
#   keep.sh SOURCE OBJECT COMPILER ARGUMENT...     writes OBJECT, and what it depends on into OBJECT.d
#
# The objects lie in a folder of ccache's cache. Those that nobody wanted for two weeks are deleted.
set -eu
source=$1 object=$2
shift 2
folder=${CCACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/ccache}/opencl

"$@" -E -P -MD -MF "$object.d" -MT "$object" "$source" -o "$object.text"
# Which files were included, and from where, is in the text.
name=$({ cat "$object.text" && "$1" --version && printf '%s\n' "$@" | grep -v '^-I\|^/'; } | sha256sum)
rm "$object.text"
kept=$folder/${name%% *}.o
if cp "$kept" "$object" 2>/dev/null; then
    touch "$kept" 2>/dev/null || true
    exit
fi
"$@" -c "$source" -o "$object"

# Other builds may do the same now, and this one may have no right to: a build does not fail because nothing is kept.
umask "${CCACHE_UMASK:-$(umask)}"
[ -z "${CCACHE_READONLY:-}" ] && mkdir -p "$folder" 2>/dev/null && cp "$object" "$kept.$$" 2>/dev/null || exit 0
mv "$kept.$$" "$kept" 2>/dev/null || true
find "$folder" -name '*.o*' -mtime +14 -delete 2>/dev/null || true
