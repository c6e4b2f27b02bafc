#!/bin/bash
# The tool's contract: exit statuses, one line an error, nothing left behind. test_cli.sh TOOL [FAULT]
# FAULT: the library fault_cl, which lets the tool's drivers fail; not of a build with sanitizers.
# Prints what failed and exits 1 if anything did.
set -u
# Under nohup, or after a shell's &, signals are ignored here and by children.
if [ -z "${HEEDS_SIGNALS:-}" ] && env --default-signal true 2>/dev/null; then
    HEEDS_SIGNALS=1 exec env --default-signal bash "$0" "$@"
fi
tool=$1
faulty=${2:-}
here=$(cd "$(dirname "$0")/.." && pwd)
osm=$here/data/santa_cruz/osm.mbtiles
tiger=$here/data/santa_cruz/tiger.mbtiles
tmp=$(mktemp -d) || exit 1
trap 'umount "$tmp/small" 2>/dev/null; rm -rf "$tmp"' EXIT
mkdir "$tmp/in" "$tmp/out" "$tmp/empty" "$tmp/spool"
# The caches of all tests, in which validate finds the programs that others have compiled. To look for leaks takes up to
# ten times as long as a run: the tests of the library and of hostile files do.
export XDG_CACHE_HOME=${XDG_CACHE_HOME:-$tmp/cache} POCL_CACHE_DIR=${POCL_CACHE_DIR:-$tmp/pocl} TMPDIR=$tmp/spool
export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0
mkdir -p "$POCL_CACHE_DIR"
cd "$tmp/out" || exit 1
checks=0
failures=0
peaks=()

fail() {
    failures=$((failures + 1))
    echo "FAILED: $name: $*"
}

# Lists the folders that the tool writes into. The shell does it, as verify does: six programs a run took longer than a run.
list_files() {
    shopt -s dotglob nullglob
    listed=("$tmp/out"/* "$tmp/spool"/*)
    shopt -u dotglob nullglob
}

# Runs a command; out, err and status are what came of it.
run() {
    list_files
    before=${listed[*]}
    "$@" >"$tmp/stdout" 2>"$tmp/stderr" </dev/null
    status=$?
    checks=$((checks + 1))
}

# expect STATUS NAME ARGUMENT...: the tool ends with the status; an error is one line, and leaves nothing.
expect() {
    local wanted=$1
    name=$2
    shift 2
    run "$tool" "$@"
    verify "$wanted"
}

verify() {
    [ "$status" = "$1" ] || fail "exit status $status, not $1: $(head -c 300 "$tmp/stderr")"
    [ "$1" = 0 ] && return
    local line errors=()
    while IFS= read -r line || [ -n "$line" ]; do
        [[ $line == 'camber: warning: '* ]] || errors+=("$line")
    done <"$tmp/stderr"
    [ ${#errors[@]} = 1 ] || fail "${#errors[@]} lines of error, not 1: $(head -c 600 "$tmp/stderr")"
    [[ ${errors[0]-} == 'camber: '*[':;)']' '?* ]] || fail "not 'camber: what, where, cure'"
    list_files
    [ "$before" = "${listed[*]}" ] || fail "left behind: ${listed[*]}"
}

says() {
    grep -q -e "$1" "$tmp/stderr" || fail "standard error lacks '$1': $(head -c 600 "$tmp/stderr")"
}

has() { # FILE TEXT...
    local file=$1 text
    shift
    for text in "$@"; do
        grep -aq -e "$text" "$file" || fail "$(basename "$file") lacks $text"
    done
}

lacks() {
    grep -aq -e "$2" "$1" && fail "$(basename "$1") has $2"
}

# Big-endian (PNG) and little-endian (GLB) 32-bit numbers at an offset.
be32() { od -An -tu1 -j"$2" -N4 "$1" | awk '{print (($1 * 256 + $2) * 256 + $3) * 256 + $4}'; }
le32() { od -An -tu1 -j"$2" -N4 "$1" | awk '{print (($4 * 256 + $3) * 256 + $2) * 256 + $1}'; }

# The stages of the summary on standard error, in ms, and the whole that they and the start make.
adds_up() {
    awk '/^start .* in all / { found = 1; split($0, half, ";"); gsub(/[^0-9. ]/, " ", half[1]); gsub(/[^0-9. ]/, " ", half[2])
            n = split(half[1], part, " "); for (i = 1; i <= n; i++) sum += part[i]; split(half[2], whole, " ")
            off = sum - whole[1] }
        END { exit !(found && off < 0.5 && off > -0.5) }' "$tmp/stderr" ||
        fail "its times do not add up: $(head -c 600 "$tmp/stderr")"
}

is_png() { # FILE WIDTH HEIGHT
    [ -s "$1" ] || { fail "no $1"; return; }
    [ "$(od -An -tx1 -N8 "$1" | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 is no PNG"
    [ "$(be32 "$1" 16)x$(be32 "$1" 20)" = "$2x$3" ] || fail "$1 is $(be32 "$1" 16) x $(be32 "$1" 20), not $2 x $3"
    [ "$(tail -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 49454e44ae426082 ] || fail "$1 is cut off"
}

# ---- Usage ----

expect 2 "no verb"
expect 2 "unknown verb" frobnicate
expect 2 "unknown option" render --bogus
grep -q 'did you mean' "$tmp/stderr" && fail "no option is close: $(cat "$tmp/stderr")"
# Letters left out, added, changed, swapped, and several of them.
for typed in --sze --sizze=3x4 --zize --siez --simplfy-xp -size; do
    expect 2 "mistyped option" render "$typed"
    says "did you mean --\(size\|simplify-px\)? "
done
expect 2 "another verb's option" info --bbox
grep -q 'did you mean' "$tmp/stderr" && fail "not one of info's: $(cat "$tmp/stderr")"
expect 2 "unknown letter" info -z
expect 2 "option of another verb" info --size 5x5
expect 2 "option without its value" render "$osm" -o
expect 2 "value for a flag" info --json=1
expect 2 "no input" render -o a.png
expect 2 "no output" render "$osm"
expect 2 "input for info" info "$osm"
expect 2 "unknown extension" render "$osm" -o a.gif
says "^camber: a\.gif: unknown extension \.gif; camber render writes png, png8[a-z, ]*webp[a-z, ]*: name it OUT\.png, or give --format$"
expect 2 "no extension" tessellate "$osm" -o maps.d/a
says "^camber: maps\.d/a: no extension; camber tessellate writes glb: name it OUT\.glb, or give --format$"
for verb in render tessellate "tiles --max-zoom 3"; do
    # shellcheck disable=SC2086
    expect 2 "two outputs: $verb" $verb "$osm" -o a.png --output=b.png
    says '^camber: -o b\.png: is the second output, after -o a\.png; give one of them$'
done
expect 2 "two outputs of merge" tiles merge "$osm" -o a.pmtiles -o a.pmtiles
expect 2 "two boxes" render "$osm" -o a.png --bbox 0,0,1,1 --bbox 1,1,2,2
says '^camber: --bbox 1,1,2,2: is the second --bbox; give one of them$'
expect 2 "two layers" render "$osm" -o a.png --layer a --layer b
expect 2 "two files of polylines" bench --polylines a --polylines b
# The last of two settings counts.
expect 2 "the last of two sizes" render "$osm" -o a.png --size 5x5 --size 0x5
says '^camber: --size 0x5: '
expect 0 "the last of two formats" render "$osm" -o a.png --format webp --format png --size 8x8
rm -f a.png
expect 2 "png from tessellate" tessellate "$osm" -o a.png
expect 2 "glb from render" render "$osm" -o a.glb
expect 2 "glb by its format" render "$osm" -o a.png --format glb
expect 2 "png8 from tessellate" tessellate "$osm" -o a.glb --format png8
expect 2 "a WebP that is a PNG" render "$osm" -o a.webp --format png8
expect 2 "a PNG that is a WebP" render "$osm" -o a.png --format webp
expect 2 "the quality of a PNG" render "$osm" -o a.png --quality 80
expect 2 "no quality" render "$osm" -o a.webp --quality 0
expect 2 "too much quality" render "$osm" -o a.webp --quality 101
expect 2 "a WebP that is too wide" render "$osm" -o a.webp --size 16384x10
says '16383\|no WebP'
expect 2 "a png8 that is too large" render "$osm" -o a.png --format png8 --size 20000x20000
says '268435456'
expect 2 "JSON and picture on standard output" render "$osm" -o - --json
for size in 0x0 0x5 5x0 1000000x1000000 1000000x5 65536x5 65535x65535 5 5x 5x5x5 -5x5 axb 5x5a 99999999999x5 ''; do
    expect 2 "size '$size'" render "$osm" -o a.png --size "$size"
done
expect 2 "size after ratio" render "$osm" -o a.png --size 40000x10 --ratio 2
for ratio in 0 -1 nan inf 1e99 2x 0x2 ''; do
    expect 2 "ratio '$ratio'" render "$osm" -o a.png --ratio "$ratio"
done
for box in 1,2,3 1,2,3,4,5 1,2,3,x 1,5,3,4 nan,2,3,4 1,2,1,3 -200,0,0,1 0,-91,1,1; do
    expect 2 "bbox $box" render "$osm" -o a.png --bbox "$box"
done
expect 2 "center without zoom" render "$osm" -o a.png --center -122,37
expect 2 "zoom without center" render "$osm" -o a.png --zoom 12
expect 2 "bbox and center" render "$osm" -o a.png --bbox 0,0,1,1 --center 0,0 --zoom 3
for pitch in -1 85.1 90 nan x ''; do
    expect 2 "pitch '$pitch'" render "$osm" -o a.png --pitch "$pitch"
done
expect 2 "pitch of a mesh" tessellate "$osm" -o a.glb --pitch 30
expect 2 "pitch of a comparison" compare "$osm" --pitch 30
expect 2 "theme and style" render "$osm" -o a.png --theme dark --style x.json
expect 2 "unknown method" render "$osm" -o a.png --method star
expect 2 "prefix of a method" render "$osm" -o a.png --method stri
expect 2 "0 threads" info --threads 0
expect 2 "bench without input" bench
expect 2 "bench of both" bench "$osm" --polylines x
expect 2 "standard input twice" render - - -o a.png
expect 2 "where twice" render "$osm" -o a.png --where 'a = 1' --where 'b = 2'
says 'AND or OR'
for gl in '--backend egl' '--backend osmesa' '--sharing copy'; do
    for verb in "render $osm -o a.png" "compare $osm" "bench $osm" info; do
        # shellcheck disable=SC2086
        expect 2 "OpenCL draws, and $gl: $verb" $verb --draw cl $gl
        says "--draw cl and ${gl% *}: .* without GL; leave out ${gl% *}, or give --draw gl"
    done
done
expect 2 "OpenCL draws, and a back end is checked" validate --draw cl --backend egl
expect 2 "compare without input" compare
expect 2 "compare with a style" compare "$osm" --style x.json
expect 2 "compare with an output" compare "$osm" -o a.png
expect 2 "compare of both" compare "$osm" --polylines x
expect 2 "compare polylines by an attribute" compare --polylines x --where 'a = 1'
expect 2 "a plot of no known kind" compare "$osm" --plot a.pdf
says '^camber: --plot a\.pdf: unknown extension \.pdf; name it OUT\.svg or OUT\.png$'
expect 2 "a plot on standard output" compare "$osm" --plot -
expect 2 "an empty filter" compare "$osm" --where ''
for tolerance in 0 -1 nan 2x; do
    expect 2 "fan tolerance '$tolerance'" compare "$osm" --fan-tolerance-px "$tolerance"
done
expect 2 "where that does not parse" render "$osm" -o a.png --where 'highway = = 3'

# ---- Help and the man page ----

sed 's/\\-/-/g' "$here/../src/cli/camber.1" | grep -o -e '--[a-z][a-z-]*' | sort -u >"$tmp/in/page"
for verb in '' render tessellate compare validate bench info; do
    expect 0 "help of '$verb'" $verb --help
    [ -s "$tmp/stderr" ] && fail "something on standard error"
    grep -o -e '--[a-z][a-z-]*' "$tmp/stdout" | sort -u >"$tmp/options"
    [ "$(wc -l <"$tmp/options")" -ge 2 ] || fail "no options in it"
    missing=$(comm -23 "$tmp/options" "$tmp/in/page")
    [ -z "$missing" ] || fail "the man page lacks $missing"
done
# A verb's help has the words that the verb takes, and not the former names of options.
expect 0 "help of render, for its formats" render --help
has "$tmp/stdout" '^      --format png|png8|webp'
lacks "$tmp/stdout" 'glb'
expect 0 "help of tessellate, for its format" tessellate --help
has "$tmp/stdout" '^      --format glb  '
expect 0 "help of tiles, for former names" help tiles
has "$tmp/stdout" '--renew FILE' '--format png|png8|webp|glb' '^Tiles:$'
lacks "$tmp/stdout" '--tiles '
# Groups, and an example of each verb, which the parser takes.
expect 0 "help by groups" --help
has "$tmp/stdout" '^Draw:$' '^Check and measure:$' '^This machine, and help:$'
for verb in render tessellate compare validate bench style tiles serve info; do
    expect 0 "the example of $verb" help $verb
    example=$(sed -n '/^Example:$/{n;s/^  //p}' "$tmp/stdout")
    case $example in "camber $verb"*) ;; *) fail "its example is '$example'" ;; esac
    expect 0 "the example of $verb, in the help of all" --help
    grep -qxF "                $example" "$tmp/stdout" || fail "lacks $example"
    expect 0 "the example of $verb, read by the parser" info --help
    eval "set -- ${example#camber }"
    expect 0 "the options of the example of $verb" "$@" --help
done
expect 0 "version" --version
has "$tmp/stdout" '^camber [0-9]*\.[0-9]*\.[0-9]*$'
expect 0 "version of a verb" render --version
cp "$tmp/stdout" "$tmp/version"
grep -q "^\.TH CAMBER 1 \"[A-Z][a-z]* 20[0-9]*\" \"$(cat "$tmp/version")\" " "$here/../src/cli/camber.1" ||
    fail "the man page is of another version"
for words in -V version 'render -V'; do
    # shellcheck disable=SC2086
    expect 0 "version by $words" $words
    cmp -s "$tmp/stdout" "$tmp/version" || fail "not what --version says"
done
for verb in '' render compare bench; do
    expect 0 "help of '$verb' by its option" $verb --help
    cp "$tmp/stdout" "$tmp/help"
    # shellcheck disable=SC2086
    expect 0 "help of '$verb' by its verb" help $verb
    cmp -s "$tmp/stdout" "$tmp/help" || fail "not what --help says"
done
expect 2 "help of an unknown verb" help frobnicate
# A verb's help speaks of no other verb, and of no option that it does not take.
for verb in render tessellate compare validate bench; do
    expect 0 "help of $verb alone" $verb --help
    for other in render tessellate compare validate bench; do
        [ $verb = $other ] || lacks "$tmp/stdout" "^  .*[ (]$other[,:)]"
    done
    case $verb in compare | validate | bench) ;; *) lacks "$tmp/stdout" '--polylines' ;; esac
    case $verb in render | bench) has "$tmp/stdout" '--pitch' ;; *) lacks "$tmp/stdout" '--pitch' ;; esac
done

# ---- Info ----

expect 0 "info" info
has "$tmp/stdout" '^camber ' '^device ' '^GL ' '^sharing ' '^formats '
expect 0 "info as JSON" info --json
has "$tmp/stdout" '"devices"' '"backends"' '"formats"' '"GPKG"' '"gdal"' '"camber"'
if ! grep -q '"sharing"' "$tmp/stdout"; then
    echo "skipped: no OpenCL device or GL here: $(grep unavailable "$tmp/stdout")"
    exit 77
fi
run env OCL_ICD_VENDORS="$tmp/empty" OPENCL_VENDOR_PATH="$tmp/empty" "$tool" info
name="info without OpenCL"
verify 0
has "$tmp/stdout" '^device *none: .'
expect 0 "info on an unknown device" info --device 'no such device' --json
has "$tmp/stdout" '"unavailable"'
expect 0 "info on what draws" info --draw cl
has "$tmp/stdout" '^draw *cl: asked for'
# Unasked it draws by OpenCL where GL is a software rasteriser, also where that has to be looked at.
expect 0 "info on what draws by itself" info --json
if grep -q '"software": false' "$tmp/stdout"; then own=gl; else own=cl; fi
has "$tmp/stdout" "\"draw\": \"$own\"" '"draw_reason": ".*GL'
expect 0 "info on what a back end draws" info --backend osmesa
has "$tmp/stdout" '^draw *gl: --backend asks for GL\|^sharing *none: '
# A machine without GL: its libraries are no libraries.
mkdir "$tmp/nogl"
for library in libEGL.so.1 libOSMesa.so.8 libOSMesa.so.6 libOSMesa.so; do
    echo 'no library' >"$tmp/nogl/$library"
done
without_gl=(env LD_LIBRARY_PATH="$tmp/nogl${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}")
run "${without_gl[@]}" "$tool" info
name="info without GL"
verify 0
has "$tmp/stdout" '^GL *egl: not available: .*; install' '^GL *osmesa: not available: .*; install' '^draw *cl: ' \
    '^sharing *none: GL is not used'

# ---- Render ----

expect 0 "render" render "$osm" -o city.png --size 300x200 -v
is_png city.png 300 200
has city.png "camber [0-9]"
lacks city.png 'OpenStreetMap' # its tiles do not say whose they are
lacks "$tmp/stderr" 'OpenStreetMap'
says '^city.png: 300 x 200 px, zoom [0-9.]* at [-0-9., ]*, [0-9.]* KB, [0-9.]* s$'
tail -n 1 "$tmp/stderr" | grep -q '^city.png: ' || fail "the last line does not say what came out"
[ $own = gl ] && says 'triangles (strip), [0-9]* draw calls*$' || says 'triangles (strip), drawn by OpenCL kernels$'
adds_up
cp city.png "$tmp/in/city.png"
expect 73 "output exists" render "$osm" -o city.png --size 30x20
cmp -s city.png "$tmp/in/city.png" || fail "the file has changed"
expect 0 "render again" render "$osm" -o city.png --size 300x200 -f -q
cmp -s city.png "$tmp/in/city.png" || fail "other bytes at the second run"
[ -s "$tmp/stderr" ] && fail "says something with -q"
expect 0 "with shared buffers" render "$osm" -o - --size 300x200 --draw gl
cp "$tmp/stdout" "$tmp/in/gl.png"
expect 0 "without shared buffers" render "$osm" -o - --size 300x200 --sharing copy
cmp -s "$tmp/stdout" "$tmp/in/gl.png" || fail "other bytes than with them"
expect 0 "to standard output" render "$osm" -o - --size 300x200
cmp -s "$tmp/stdout" "$tmp/in/city.png" || fail "other bytes than in a file"
expect 0 "png8" render "$osm" -o few.png --size 300x200 --format png8
is_png few.png 300 200
has few.png PLTE "camber [0-9]"
[ "$(stat -c %s few.png)" -lt "$(stat -c %s city.png)" ] || fail "is longer than all colours"
expect 0 "png8 to standard output" render "$osm" -o - --size 300x200 --format png8
cmp -s "$tmp/stdout" few.png || fail "other bytes than in a file"
expect 0 "one colour" render "$osm" -o blank.png --size 300x200 --center 0,0 --zoom 12
[ "$(stat -c %s blank.png)" -lt 250 ] || fail "$(stat -c %s blank.png) bytes of one colour"
rm blank.png
run "$tool" render "$osm" -o city.webp --size 300x200
if grep -q 'no WebP' "$tmp/stderr"; then
    verify 2
else
    name=WebP
    verify 0
    [ "$(head -c 4 city.webp)$(head -c 12 city.webp | tail -c 4)" = RIFFWEBP ] || fail "is no WebP"
    expect 0 "a lossless WebP" render "$osm" -o all.WEBP --size 300x200 --quality 100
    [ "$(stat -c %s city.webp)" -lt "$(stat -c %s all.WEBP)" ] || fail "is longer than all pixels"
    expect 0 "WebP to standard output" render "$osm" -o - --size 300x200 --format webp
    cmp -s "$tmp/stdout" city.webp || fail "other bytes than in a file"
    rm city.webp all.WEBP
fi
rm few.png
expect 0 "ratio" render "$osm" -o ratio.PNG --size 100x50 --ratio 2
is_png ratio.PNG 200 100
ln -s city.png link.png
expect 73 "a link exists" render "$osm" -o link.png
expect 0 "through a link" render "$osm" -o link.png -fq --size 20x10
[ -L link.png ] || fail "the link is gone"
is_png city.png 20 10
chmod 640 city.png
expect 0 "keeps the mode" render "$osm" -o city.png -fq --size 20x10
[ "$(stat -c %a city.png)" = 640 ] || fail "mode $(stat -c %a city.png)"
expect 0 "JSON" render "$tiger" -o tiger.png --size 64x64 --json --method kite --coverage linear
has "$tmp/stdout" '"width": 64' '"device"' '"gl_renderer"' '"sharing"' '"draw_calls"' '"peak_rss_bytes"' '"total_ms"' \
    '"attribution": null' '"method": "kite"' '"coverage": "linear"' '"triangles": [1-9]'
lacks tiger.png OpenStreetMap
expect 0 "drawn in OpenCL" render "$osm" -o cl.png --size 300x200 --draw cl --json
has "$tmp/stdout" '"draw": "cl"' '"draw_reason": "asked for"' '"gl_renderer": null' '"sharing": "none"'
is_png cl.png 300 200
for draw in cl auto; do
    [ $draw = cl ] || [ $own = cl ] || continue
    name="what is loaded for --draw $draw"
    LD_DEBUG=files "$tool" render "$osm" -o cl.png -f --size 300x200 --draw $draw 2>"$tmp/loaded" || fail "does not draw"
    grep -q 'libOpenCL' "$tmp/loaded" || fail "says nothing of what it loads"
    [ -e /dev/dri ] && [ $draw = auto ] && continue # where GL may be hardware, it is looked at
    ! grep -Eq 'lib(EGL|OSMesa|GL|GLESv2)\.so' "$tmp/loaded" || fail "GL is loaded for what OpenCL draws"
done
expect 0 "pitch in OpenCL" render "$osm" -o pitch.png --size 64x64 --draw cl --center=-122,37 --zoom 15 --pitch 40
is_png pitch.png 64 64
expect 0 "in one thread" render "$osm" -o one.png --size 300x200 --draw cl --threads 1
cmp -s one.png cl.png || fail "other bytes than with all threads"
rm -f cl.png one.png pitch.png
run "${without_gl[@]}" "$tool" render "$osm" -o bare.png --size 300x200 --json
name="render without GL"
verify 0
has "$tmp/stdout" '"draw": "cl"' '"draw_reason": "no ' '"gl_renderer": null'
expect 0 "the same, asked for" render "$osm" -o asked.png --size 300x200 --draw cl
cmp -s bare.png asked.png || fail "other bytes than --draw cl"
rm -f bare.png asked.png
run "${without_gl[@]}" "$tool" render "$osm" -o bare.png --draw gl
name="GL where there is none"
verify 69
says 'neither EGL nor OSMesa .*; install libegl1.*--draw cl'
run "${without_gl[@]}" "$tool" render "$osm" -o bare.png --backend egl
name="EGL where there is none"
verify 69
says 'EGL: .*; install libegl1'
expect 0 "few draw calls" render "$osm" --no-labels -o calls.png --size 512x512 --json --draw gl
has "$tmp/stdout" '"draw_calls": [1-4],'
expect 0 "draw calls in words" render "$osm" --no-labels -o calls.png -f --size 64x64 --draw gl -v
says 'triangles (strip), [1-4] draw calls*$'
adds_up
expect 0 "no draw calls of kernels" render "$osm" -o calls.png -f --size 64x64 --draw cl --json
has "$tmp/stdout" '"draw_calls": 0,' '"start_ms": [0-9]'
rm -f calls.png
# A system without fontconfig's configuration has no fonts to find, and nothing is said of that.
run env FONTCONFIG_FILE="$tmp/none" "$tool" render "$osm" -qfo calls.png --size 600x400
verify 0
[ ! -s "$tmp/stderr" ] || fail "says $(head -c 300 "$tmp/stderr")"
rm -f calls.png
# A picture of up to 2^22 pixels is drawn where it is compressed, without a copy of its 16 MB in between.
if [ -n "$faulty" ]; then
    for size in 2048x2048 2049x2048; do
        expect 0 "memory of $size" render "$osm" --no-labels -o large.png -f --size $size --draw cl --json
        peaks+=("$(sed -n 's/.*"peak_rss_bytes": \([0-9]*\).*/\1/p' "$tmp/stdout")")
    done
    [ $((peaks[0] + (4 << 20))) -lt "${peaks[1]}" ] || fail "as much as with a copy: ${peaks[*]} bytes"
    rm large.png
fi
cat >"$tmp/in/refs.geojson" <<'JSON'
{"type": "FeatureCollection", "features": [
 {"type": "Feature", "properties": {"highway": "primary", "ref": "D 6007"},
  "geometry": {"type": "LineString", "coordinates": [[7.40, 43.73], [7.44, 43.73]]}},
 {"type": "Feature", "properties": {"highway": "primary", "ref": "Route de Menton"},
  "geometry": {"type": "LineString", "coordinates": [[7.40, 43.72], [7.44, 43.72]]}}]}
JSON
expect 0 "a number has a shield, a name has none" render "$tmp/in/refs.geojson" --style city --center 7.42,43.725 \
    --zoom 13 --size 300x300 -o refs.png -v
says ' 1 label,'
rm -f refs.png
monaco=$here/data/monaco/monaco.osm.pbf
# With a file of another format, the whole document of the style is read. The line is far away.
echo '{"type":"LineString","coordinates":[[100,10],[101,11]]}' >"$tmp/in/far.geojson"
at=(--center 7.42,43.73 --zoom 14 --size 300x300 --attribution "")
expect 0 "an extract in the default style" render "$monaco" -o extract.png "${at[@]}"
expect 0 "an extract and another file" render "$monaco" "$tmp/in/far.geojson" -o two.png "${at[@]}"
cmp -s extract.png two.png || fail "the styles differ"
expect 0 "an archive in the default style" tiles "$monaco" -o extract.mbtiles --max-zoom 5
expect 0 "an archive in the same style, by its name" tiles "$monaco" -o extract.mbtiles --max-zoom 5 --resume --style city
rm -f extract.png two.png extract.mbtiles
expect 0 "one thread, dark" render "$tiger" -o dark.png --size 64x64 --theme dark --threads 1
cmp -s dark.png tiger.png && fail "dark looks like light"
expect 0 "more threads than cores" render "$tiger" -o many.png --size 64x64 --theme dark --threads $(($(nproc) + 1))
cmp -s dark.png many.png || fail "the number of threads shows"
for size in 0 262143 64K 255K 1025G 1T 1.5M 12Q -1 M 1000000000000G 99999999999999999999 ''; do
    expect 2 "memory of '$size'" render "$osm" -o a.png --memory "$size"
done
# The text of a picture has no size of memory in it: the files are the same. The style draws every line, however far.
echo '{"version":8,"sources":{},"layers":[{"id":"a","type":"line","paint":{"line-width":4}}]}' >"$tmp/in/all.json"
# OpenCL's drawing takes 4 MB besides, or a quarter of what there is.
for kind in "strip gl 0" "fan gl 0" "strip cl 4194304" "fan cl 4194304"; do
    read -r method draw besides <<<"$kind"
    expect 0 "all the memory, $method, $draw" render "$osm" --style "$tmp/in/all.json" -o whole.png --size 700x500 --method $method --draw $draw --json
    most=$(sed -n 's/.*"meshes_most_bytes": \([0-9]*\).*/\1/p' "$tmp/stdout")
    for part in 3 10; do
        expect 0 "1/$part of the memory, $method, $draw" render "$osm" --style "$tmp/in/all.json" -o part.png --size 700x500 --method $method \
            --draw $draw --json --memory $((most / part))
        cmp -s whole.png part.png || fail "the bound shows in the picture"
        held=$(sed -n 's/.*"meshes_most_bytes": \([0-9]*\).*/\1/p' "$tmp/stdout")
        [ "$held" -gt $((most / part / 2)) ] && [ "$held" -le $((most / part + besides)) ] || fail "$held of $most bytes held"
        rm part.png
    done
    rm whole.png
done
expect 0 "a mesh" tessellate "$osm" -o whole.glb
expect 0 "a mesh in little memory" tessellate "$osm" -o part.glb --memory 256K
cmp -s whole.glb part.glb || fail "the bound shows in the mesh"
rm whole.glb part.glb
awk 'BEGIN { printf "{\"type\": \"LineString\", \"coordinates\": [[0, 0]"
    for (i = 1; i < 12000; i++) printf ", [%g, %d]", i / 1000, i % 2; print "]}" }' >"$tmp/in/long.geojson"
expect 65 "memory that one line overfills" render "$tmp/in/long.geojson" -o a.png --memory 256K
says 'polyline 0 takes [0-9]* bytes, more than half of the 262144 that meshes may hold; allow more memory'
expect 0 "memory that it does not" render "$tmp/in/long.geojson" -o a.png --memory 4M -v
says 'without them it may take 128M (the least), of which'
rm a.png
if command -v taskset >/dev/null && [ "$(nproc)" -gt 1 ]; then
    name="not on the first core"
    checks=$((checks + 1))
    last=$(taskset -cp $$ | grep -oE '[0-9]+$')
    taskset -c "$last" "$tool" render "$tiger" -qo pinned.png --size 64x64 --theme dark || fail "exit status $?"
    cmp -s dark.png pinned.png || fail "the cores show"
fi
expect 0 "two inputs" render "$osm" "$tiger" -o two.png --size 64x64
credit='(c) Ümläut & <Söhne>'
expect 0 "an attribution" render "$tiger" -o signed.png --size 64x64 --attribution "$credit"
has signed.png "$credit"
says "^$credit\$"
expect 0 "an attribution as JSON" render "$tiger" -o signed.png -f --size 64x64 --attribution "$credit" --json
has "$tmp/stdout" "\"attribution\": \"$credit\""
expect 0 "an attribution of a mesh" tessellate "$tiger" -o signed.glb --attribution "$credit"
has signed.glb "$credit"
expect 2 "an attribution that is no text" render "$tiger" -o a.png --attribution $'\xff'
rm -f signed.glb
expect 0 "pitch" render "$osm" -o tilted.png --center -122.03,36.974 --zoom 14 --bearing 30 --pitch 85 --size 99x77
expect 0 "centre and zoom" render "$osm" -o close.png --center -122.03,36.974 --zoom 14 --bearing 30 --size 99x77
is_png close.png 99 77
expect 0 "nothing in the view" render "$osm" -o nothing.png --bbox 10,10,11,11 --size 50x50
is_png nothing.png 50 50
says '^camber: warning: nothing is drawn: .* in the view; .* (--bbox is W,S,E,N: longitudes come first)$'
expect 0 "nothing in the view, tessellated" tessellate "$osm" -o nothing.glb --bbox 10,10,11,11
[ "$(le32 nothing.glb 8)" = "$(stat -c %s nothing.glb)" ] || fail "no whole GLB"
says '^camber: warning: '
rm -f nothing.glb
run sh -c "'$tool' render - -o - --size 64x64 -q <'$osm' >'$tmp/in/stdin.png'"
name="standard input"
verify 0
is_png "$tmp/in/stdin.png" 64 64
[ -z "$(ls -A "$TMPDIR")" ] || fail "left in TMPDIR: $(ls -A "$TMPDIR")"
name="a spoilt cache"
spoilt=0
for force in -q -qf; do
    (export CAMBER_KERNELS= XDG_CACHE_HOME="$tmp/spoilt" && "$tool" render "$osm" -o spoilt.png --size 300x200 $force)
    cmp -s spoilt.png "$tmp/in/city.png" || fail "other bytes than before"
    for file in "$tmp/spoilt"/camber/*; do
        [ -f "$file" ] && head -c 3000 /dev/urandom >"$file" && spoilt=$((spoilt + 1))
    done
done
[ $spoilt -gt 0 ] || fail "nothing is kept there"
rm -f -- *.png *.PNG

# ---- Tessellate, bench, validate ----

for method in strip kite fan; do
    expect 0 "tessellate, $method" tessellate "$osm" -o mesh.glb -f --method $method --size 200x200 --json
    [ "$(head -c 4 mesh.glb)" = glTF ] || fail "no GLB"
    [ "$(le32 mesh.glb 8)" = "$(stat -c %s mesh.glb)" ] || fail "its head says $(le32 mesh.glb 8) bytes"
    has mesh.glb POSITION
    has "$tmp/stdout" "\"output_bytes\": $(stat -c %s mesh.glb)" "\"method\": \"$method\"" '"triangles": [1-9]'
done
rm -f mesh.glb
keys=('"device"' '"gl_renderer"' '"sharing"' '"draw"' '"polylines"' '"points_in"' '"segments_in"' '"points"' '"segments"'
    '"runs"' '"tessellate_ms"' '"draw_ms"' '"frame_ms"' '"stage_ms"' '"min"' '"median"' '"max"' '"vertices"'
    '"triangles"' '"bytes"' '"draw_calls"' '"peak_rss_bytes"')
expect 0 "bench of a map" bench "$osm" --json --runs 2 --size 128x128 --dump lines.bin
has "$tmp/stdout" "${keys[@]}"
[ "$(le32 lines.bin 0)" = $((0x4c594c50)) ] || fail "the dump has no magic"
polylines=$(le32 lines.bin 4)
points=$(le32 lines.bin 8)
[ "$(stat -c %s lines.bin)" = $((12 + 4 * (polylines + 1) + 8 * points)) ] || fail "the dump has a wrong size"
expect 0 "bench of its dump" bench --polylines lines.bin --width-px 3 --json --runs 2 --size 128x128 -o lines.png \
    --dump again.bin
has "$tmp/stdout" "${keys[@]}" "\"polylines\": $polylines," "\"points_in\": $points," '"runs": 2' "\"draw\": \"$own\""
is_png lines.png 128 128
cmp -s lines.bin again.bin || fail "the dump of the dump differs"
expect 0 "bench as a table" bench --polylines lines.bin --runs 1 --size 64x64
has "$tmp/stdout" '^tessellate ' '^draw ' '^frame ' '^classify ' '^scan ' '^emit '
head -c 1000 lines.bin >"$tmp/in/cut.bin"
expect 65 "polylines cut off" bench --polylines "$tmp/in/cut.bin"
expect 65 "polylines of text" validate --polylines "$here/tool/test_cli.sh"
expect 66 "no such polylines" bench --polylines "$tmp/in/none.bin"
expect 65 "a folder of polylines" bench --polylines "$tmp/in"
cp lines.bin "$tmp/in/lines.bin"
rm -f lines.bin again.bin lines.png

# ---- Compare ----

# value NAME...: what stands at a path in the JSON on standard output.
value() {
    python3 -IS -c 'import json, sys
at = json.load(open(sys.argv[1]))
for step in sys.argv[2:]:
    at = at[int(step)] if isinstance(at, list) else at[step]
print(len(at) if isinstance(at, list) else at)' "$tmp/stdout" "$@" 2>/dev/null
}

# holds EXPRESSION...: of the JSON on standard output as j, its networks as n, their average as a. One Python for all of them.
holds() {
    local not
    not=$(python3 -IS -c 'import json, sys
j = json.load(open(sys.argv[1])); n = j["networks"]; a = j["average"]
for text in sys.argv[2:]:
    try:
        so, why = eval(text), ""
    except Exception as error:
        so, why = False, repr(error)
    if not so:
        print("not so:", text, why)' "$tmp/stdout" "$@" 2>&1)
    [ -z "$not" ] || fail "$not"
}

small=(--runs 1 --size 96x96)
filters=(--where "type = 'primary'" --where "type IN ('primary', 'secondary')")
expect 0 "compare two networks" compare "$osm" "${filters[@]}" "${small[@]}" --json
if command -v python3 >/dev/null; then
    so=('len(n) == 2 and n[0]["name"] == "type = '"'primary'"'"')
    for member in polylines segments joins tight_joins split_joins; do
        so+=("0 < n[0]['$member'] < n[1]['$member'] or '$member' == 'split_joins'"
            "abs(a['$member'] - (n[0]['$member'] + n[1]['$member']) / 2) < 1e-9")
    done
    so+=('all(sum(r["joins_by_turn_deg"].values()) == r["joins"] and len(r["joins_by_turn_deg"]) == 6 for r in n)')
    for member in repeated_at_plain_joins repeated_at_tight_joins repeated_at_split_joins repeated_elsewhere; do
        so+=("all('$member' in r['methods'][m] for r in n for m in r['methods'])")
    done
    for member in vertices triangles bytes draw_calls_16_bit draw_calls fragments drawn_pixels repeated_pixels \
        mean_error max_error tessellate_ms draw_ms; do
        so+=("all(r['methods'][m]['$member'] > 0 for r in n for m in ('fan', 'kite', 'strip'))"
            "abs(j['ratio_to_kite']['fan']['$member'] * a['methods']['kite']['$member'] /
            a['methods']['fan']['$member'] - 1) < 1e-2 + ('$member'.endswith('_ms') and # rounded to a microsecond
            5e-4 / a['methods']['kite']['$member'] + 5e-4 / a['methods']['fan']['$member'])")
    done
    # Two triangles a segment and none a join, at most; a fan and a kite have joins of their own.
    so+=('all(r["methods"]["strip"]["triangles"] <= 2 * r["segments"] for r in n)'
        'all(r["methods"]["kite"]["triangles"] >= 2 * r["segments"] + 2 * r["joins"] for r in n)'
        'all(r["methods"][m]["fragments"] >= r["methods"][m]["drawn_pixels"] > r["methods"][m]["repeated_pixels"]
        for r in n for m in r["methods"])')
    # Neighbouring segments of kite and strip draw a pixel once wherever their join has room; bodies of a fan do not.
    so+=('all(r["methods"][m]["repeated_at_plain_joins"] == 0 for r in n for m in ("kite", "strip"))'
        'all(r["methods"]["fan"]["repeated_at_plain_joins"] > 0 for r in n)'
        'j["ratio_to_kite"]["fan"]["repeated_at_plain_joins"] is None')
    # Lines cover the same pixels whatever draws them, and no pixel is off by more than all of it.
    so+=('all(abs(r["methods"][m]["drawn_pixels"] / r["methods"]["strip"]["drawn_pixels"] - 1) < 0.02
        for r in n for m in r["methods"])'
        'all(r["methods"][m]["mean_error"] < 10 and r["methods"][m]["max_error"] <= 255
        for r in n for m in r["methods"])')
    holds "${so[@]}"
    # The view is that of both networks together, also for the first, which reaches less far.
    cp "$tmp/stdout" "$tmp/in/both.json"
    both=$(value zoom)
    expect 0 "the second network alone" compare "$osm" --where "type IN ('primary', 'secondary')" "${small[@]}" --json
    [ "$(value zoom)" = "$both" ] || fail "zoom $(value zoom), not $both"
    expect 0 "the first network alone" compare "$osm" "${filters[@]:0:2}" "${small[@]}" --json
    holds "j['zoom'] > $both and n[0]['segments'] == a['segments']"
    # Twice the width, finer fans, one method.
    expect 0 "wider" compare "$osm" "${filters[@]:0:2}" "${small[@]}" --json --width-px 16 --fan-tolerance-px 1e-3
    fan=$(value average methods fan triangles)
    kite=$(value average methods kite triangles)
    [ "${fan:-0}" -gt "${kite:-0}" ] || fail "$fan triangles of fine fans, $kite of kites"
    holds 'j["line_width_px"] == 16 and j["fan_tolerance_px"] == 0.001'
    expect 0 "one method" compare "$osm" "${filters[@]:0:2}" "${small[@]}" --json --method kite --coverage linear --simplify-px 1
    holds 'list(a["methods"]) == ["kite"] and "ratio_to_kite" not in j and j["coverage"] == "linear"'
    expect 0 "polylines to compare" bench "$osm" "${filters[@]:0:2}" "${small[@]}" --dump lines.bin -q
    expect 0 "polylines" compare --polylines lines.bin --width-px 3 "${small[@]}" --json
    holds "len(n) == 1 and n[0]['polylines'] == $(le32 lines.bin 4) and n[0]['joins'] > 0"
    rm -f lines.bin
    expect 0 "a network without lines" compare "$osm" "${filters[@]:0:2}" --where "type = 'none such'" \
        "${small[@]}" --json
    holds 'n[1]["polylines"] == 0 and n[1]["methods"]["strip"]["vertices"] == 0 and n[0]["polylines"] > 0'
    says '^camber: warning: '
    # Kernels have no fragments and no draw calls; they draw any mesh alike, and what they draw is held to the truth.
    expect 0 "compare in OpenCL" compare "$osm" "${filters[@]:0:2}" "${small[@]}" --json --draw cl
    so=('j["draw"] == "cl" and j["draw_reason"] == "asked for" and j["gl_renderer"] is None')
    for member in draw_calls draw_calls_16_bit fragments drawn_pixels repeated_pixels repeated_at_plain_joins \
        repeated_at_tight_joins repeated_at_split_joins repeated_elsewhere; do
        so+=("all(r['methods'][m]['$member'] is None for r in n + [a] for m in r['methods'])"
            "j['ratio_to_kite']['fan']['$member'] is None")
    done
    for member in vertices triangles bytes mean_error max_error tessellate_ms draw_ms; do
        so+=("all(r['methods'][m]['$member'] > 0 for r in n for m in ('fan', 'kite', 'strip'))")
    done
    holds "${so[@]}" 'all(r["methods"][m]["mean_error"] < 10 for r in n for m in r["methods"])'
    run "${without_gl[@]}" "$tool" compare "$osm" "${filters[@]:0:2}" "${small[@]}" --json
    name="compare without GL"
    verify 0
    holds 'j["draw"] == "cl" and n[0]["methods"]["kite"]["fragments"] is None'
else
    echo "skipped: what compare counts: no python3 to read its JSON"
fi
expect 0 "compare in OpenCL, as a table" compare "$osm" "${filters[@]:0:2}" "${small[@]}" --draw cl
has "$tmp/stdout" 'drawn in OpenCL' "exist only in GL"
lacks "$tmp/stdout" 'fragments: shaded'
expect 0 "compare counts in GL, unless asked" compare "$osm" "${filters[@]:0:2}" "${small[@]}" --json
has "$tmp/stdout" '"draw": "gl"'
expect 0 "compare as a table" compare "$osm" "${filters[@]}" "${small[@]}"
has "$tmp/stdout" '^network .* polylines .* joins .* 150-180' '^average .* fan ' '^average .* kite ' '^average .* strip ' \
    "^to one of kite's  *fan "
run sh -c "'$tool' compare - --where \"type = 'primary'\" --where \"type = 'secondary'\" --runs 1 --size 64x64 <'$osm'"
name="standard input, read more than once"
verify 0
[ -z "$(ls -A "$TMPDIR")" ] || fail "left in TMPDIR: $(ls -A "$TMPDIR")"
expect 2 "one where that does not parse" compare "$osm" "${filters[@]:0:2}" --where 'type = = 3' "${small[@]}"
expect 66 "compare of nothing" compare "$tmp/in/none.osm.pbf"
expect 69 "compare on an unknown device" compare "$osm" --device 'no such device'
run env PATH="$tmp/empty" "$tool" compare "$osm" --plot bars.svg
name="a plot without gnuplot"
verify 69
says 'apt install gnuplot-nox'
mkdir "$tmp/broken"
printf '#!/bin/sh\n[ "$1" = --version ] && exit 0\ncat >/dev/null\necho no terminal here >&2\nexit 1\n' >"$tmp/broken/gnuplot"
chmod +x "$tmp/broken/gnuplot"
run env PATH="$tmp/broken:$PATH" "$tool" compare "$osm" "${filters[@]}" "${small[@]}" --plot bars.svg
name="a gnuplot that fails"
verify 69
says 'no terminal here'
touch bars.svg
expect 73 "plot exists" compare "$osm" --plot bars.svg
[ -s bars.svg ] && fail "the file has changed"
expect 73 "plot in no folder" compare "$osm" --plot none/bars.svg
if command -v gnuplot >/dev/null; then
    expect 0 "plot as SVG" compare "$osm" "${filters[@]}" "${small[@]}" --plot bars.svg -f --json
    has bars.svg '<svg' '</svg>' 'Fan, kite, strip: averages of 2 networks, 96 x 96 px, lines 8 px wide' \
        '>vertices<' '>fragments shaded<' '>mean error' '>fan<' '>kite<' '>strip<'
    expect 0 "plot as PNG" compare "$osm" "${filters[@]:0:2}" "${small[@]}" --method fan --plot bars.PNG -q
    is_png bars.PNG 2240 720
else
    echo "skipped: plots: no gnuplot"
fi
rm -f bars.svg bars.PNG

# ---- Validate ----

# The report in $tmp/stdout is TAP whose plan counts its checks, all of which passed.
passes() {
    local plan
    plan=$(sed -n 's/^1\.\.//p' "$tmp/stdout")
    [ "$(head -n 1 "$tmp/stdout")" = "TAP version 14" ] || fail "no version of TAP"
    [ "${plan:-0}" -ge "$1" ] || fail "plan of '$plan'"
    [ "$(grep -c '^ok ' "$tmp/stdout")" = "${plan:-0}" ] || fail "$(grep -c '^ok ' "$tmp/stdout") ok of $plan"
    [ "$(sed -n 's/^ok \([0-9]*\) .*/\1/p' "$tmp/stdout" | tail -n 1)" = "${plan:-0}" ] || fail "the last is not $plan"
    lacks "$tmp/stdout" '^not ok'
    lacks "$tmp/stdout" '# SKIP *$'
}

is_xml() {
    if command -v xmllint >/dev/null; then
        xmllint --noout "$1" || fail "$1 is not well-formed"
    elif command -v python3 >/dev/null; then
        python3 -c 'import sys, xml.etree.ElementTree as t; t.parse(sys.argv[1])' "$1" || fail "$1 is not well-formed"
    fi
}

is_json() {
    if command -v python3 >/dev/null; then
        python3 -c 'import sys, json; json.load(open(sys.argv[1], encoding="utf-8"))' "$1" || fail "$1 is no JSON"
    fi
}

lines=$tmp/in/lines.bin
expect 0 "validate, a line a group" validate --polylines "$lines" --size 256x256 --draw cl --method strip --windows 8
passes 4
has "$tmp/stdout" ': meshes as the CPU twin.s: [0-9]* checks' ': pictures as the CPU twin' ': pixels as the oracle' ': networks under five cameras'
says '^--full draws by every method, '
says '^validate: [0-9,]* checks, 0 failed, [0-9]* skipped, [0-9.]* .*s$'
head -c 4 "$lines" >"$tmp/in/short.bin"
expect 0 "validate" validate -v --only roads --method strip --windows 8 --junit built-in.xml --pictures pictures
passes 60
has "$tmp/stdout" ': as the CPU twin, on ' ': the same bytes from run to run, on ' ': the same bytes in work-groups of 64, on ' \
    ': the same bytes in parts, on ' ': pixels, on ' '^# .* pixels: mean ' ': network, zoomed out: strip: as the CPU twin, on ' \
    ': network, cut: strip: the same bytes in parts, on ' ': network, within a segment: no point far outside the picture' \
    ': network, simplified, turned: strip, as styled: pixels, on '
is_xml built-in.xml
has built-in.xml '<testsuites ' '<testsuite ' '<testcase ' 'failures="0"'
[ "$(grep -c '<testcase ' built-in.xml)" = "$(sed -n 's/^1\.\.//p' "$tmp/stdout")" ] || fail "other cases than checks"
[ -e pictures ] && fail "a folder of pictures without a failure"
cp built-in.xml "$tmp/in/built-in.xml"
expect 73 "the JUnit file exists" validate --polylines "$lines" --junit built-in.xml
cmp -s built-in.xml "$tmp/in/built-in.xml" || fail "the file has changed"
expect 65 "no JUnit file of a run that fails" validate --polylines "$tmp/in/short.bin" --junit new.xml
expect 73 "a JUnit file in no folder" validate --polylines "$lines" --junit none/a.xml
expect 73 "a folder as the JUnit file" validate --polylines "$lines" --junit "$tmp/in" -f
expect 2 "JUnit to standard output" validate --junit -
expect 2 "too few windows" validate --windows 7
expect 2 "no such group of checks" validate --polylines "$lines" --only 'no such'
says "^camber: --only no such: no group of checks has this in its name; "
expect 2 "no group of checks" validate --polylines "$lines" --only devices
expect 0 "one group of checks" validate --polylines "$lines" --size 256x256 --only ': meshes' --method strip
has "$tmp/stdout" '^ok .*: meshes as the CPU twin.s: [0-9]* checks$'
lacks "$tmp/stdout" ' as the oracle.s:\|networks under\|: pictures as'
expect 73 "pictures into a file" validate --polylines "$lines" --pictures "$lines"
expect 73 "pictures into a folder with files" validate --polylines "$lines" --pictures "$tmp/in"
expect 73 "pictures into a folder in no folder" validate --polylines "$lines" --pictures none/pictures
expect 0 "validate polylines" validate --polylines "$lines" --size 256x256 --json --junit built-in.xml -f --only pixels --windows 8
is_json "$tmp/stdout"
has "$tmp/stdout" '"checks": [1-9]' '"failed": 0' '"skipped": [0-9]' '"failures": \[\]' '"skips": \[' '"pixels": \[' \
    '"reason": ' '"bounds": ' '"mean": ' '"past_64": ' '"windows": 8'
cmp -s built-in.xml "$tmp/in/built-in.xml" && fail "the file has not changed"
rm -f built-in.xml
expect 0 "validate a map" validate -v "$tiger" --method kite --size 100x100 --windows 8 --backend osmesa
passes 40
has "$tmp/stdout" ': network, zoomed in: kite: as the CPU twin, on '
lacks "$tmp/stdout" 'EGL'
expect 0 "validate a map's areas" validate -v "$monaco" --method strip --size 300x300 --windows 8
passes 60
has "$tmp/stdout" ': as styled, areas and lines: drawn as by the CPU twin, on ' ': layer 1 of areas: strip, filled: pixels, on .*, OpenCL$' \
    ': layer 5 of areas: strip, filled: pixels, on .*, EGL$' '^# .* pixels: mean '
expect 0 "validate a style of lines alone" validate -v "$monaco" --style roads --method strip --size 100x100 --draw cl
lacks "$tmp/stdout" 'of areas\|as styled, areas'
expect 0 "validate what kernels draw" validate -v --polylines "$lines" --size 256x256 --draw cl --only pixels --windows 8
passes 3
has "$tmp/stdout" ': pixels, on .*, OpenCL$' ': united, on .*, OpenCL$'
lacks "$tmp/stdout" 'EGL'
lacks "$tmp/stdout" 'OSMesa'
expect 0 "validate what GL draws" validate -v --polylines "$lines" --size 256x256 --draw gl --only pixels --method strip --windows 8
lacks "$tmp/stdout" ', OpenCL$'
expect 0 "validate both" validate -v --polylines "$lines" --size 256x256 --only pixels --method strip --windows 8
has "$tmp/stdout" ': OpenCL as E\|: OpenCL as O'
run "${without_gl[@]}" "$tool" validate -v --polylines "$lines" --size 256x256 --only pixels --method strip --windows 8
name="validate without GL"
verify 0
passes 5
has "$tmp/stdout" ': pixels, on .*, OpenCL$' '^ok .* EGL # SKIP .' '^ok .* OSMesa # SKIP .'
name="odd names"
odd=$tmp/in/$'a#b\\<c>&"d\'\xff\n\x01.bin'
cp "$lines" "$odd"
run "$tool" validate -v --polylines "$odd" --only meshes --method strip --windows 8 --junit odd.xml
verify 0
passes 12
has "$tmp/stdout" 'a\\#b'
is_xml odd.xml
has odd.xml 'a#b' '&lt;c&gt;&amp;&quot;d'
rm -f odd.xml "$odd"
run env POCL_DEVICES='pthread pthread' "$tool" validate -v --polylines "$lines" --size 256x256 --only meshes --method strip --windows 8
name="two devices of one name"
verify 0
if grep -q 'twin, on pthread' "$tmp/stdout"; then
    has "$tmp/stdout" ': as the CPU twin, on pthread.* (2)$'
fi
name="no EGL"
run env __EGL_VENDOR_LIBRARY_FILENAMES="$tmp/in/none.json" "$tool" validate -v --polylines "$lines" --size 256x256 --only pixels --method strip --windows 8
verify 0
passes 10
if grep -q '^ok .* EGL # SKIP .' "$tmp/stdout"; then
    run env __EGL_VENDOR_LIBRARY_FILENAMES="$tmp/in/none.json" "$tool" validate --polylines "$lines" --size 256x256 --backend egl
    name="no EGL, though asked for"
    verify 69
fi

# One segment: few pixels, all alike, a diagonal among them, and what is no number.
segment() { # X Y X Y, floats as little-endian bytes
    printf 'PLYL\1\0\0\0\2\0\0\0\0\0\0\0\2\0\0\0%b' "$1$2$3$4" >"$tmp/in/segment.lines"
}
three='\0\0\0100\0100' four='\0\0\0200\0100' fifty='\0\0\0110\0102' nan='\0\0\0300\0177' far='\0231\0166\0226\0176'
for ends in "three three three four" "three three four four" "three three fifty fifty" "nan nan nan nan" "far three far far" \
    "three three far far"; do
    read -r x0 y0 x1 y1 <<<"$ends"
    segment "${!x0}" "${!y0}" "${!x1}" "${!y1}"
    expect 0 "one segment: $ends" validate --polylines "$tmp/in/segment.lines" --size 64x64 --method strip -q
done

# ---- Bad input ----

# Until the system's limits drivers have no part in what is tested: the back end cpu, if it was built, starts in less time.
drivers=${CAMBER_CPU-}
unset CAMBER_CPU
touch "$tmp/in/empty.geojson" "$tmp/in/empty.osm.pbf" "$tmp/in/empty"
head -c 30000 "$osm" >"$tmp/in/cut.mbtiles"
head -c 30000 /dev/urandom >"$tmp/in/random.osm.pbf"
head -c 30000 /dev/urandom >"$tmp/in/random.geojson"
line='{"type":"Feature","properties":{"highway":"primary"},"geometry":{"type":"LineString","coordinates":[[1,1],[2,2]]}}'
echo "{\"type\":\"FeatureCollection\",\"features\":[$line]}" >"$tmp/in/line.geojson"
echo "{\"type\":\"FeatureCollection\",\"features\":[$line,${line%??????????}" >"$tmp/in/cut.geojson"
echo '{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"highway":"x"},"geometry":{"type":"Point",
"coordinates":[1,1]}}]}' >"$tmp/in/points.geojson"
sed 's/\[\[1,1\],\[2,2\]\]/[["a","b"],["c","d"]]/' "$tmp/in/line.geojson" >"$tmp/in/words.geojson"
expect 66 "missing" render "$tmp/in/none.osm.pbf" -o a.png
for file in empty.geojson empty.osm.pbf empty cut.mbtiles random.osm.pbf random.geojson cut.geojson \
    words.geojson; do
    expect 65 "$file" render "$tmp/in/$file" -o a.png
    expect 65 "$file, tessellated" tessellate "$tmp/in/$file" -o a.glb --json
    [ -s "$tmp/stdout" ] && fail "an error has something on standard output"
done
echo '{"version":8,"sources":{},"layers":[{"id":"a","type":"line","filter":["==",["get","highway"],"primary"]}]}' >"$tmp/in/primary.json"
expect 65 "points in a style of lines" render "$tmp/in/points.geojson" -o a.png --style "$tmp/in/primary.json"
printf 'root:x:0:0:root:/root:/bin/sh\n' >"$tmp/in/text"
cp "$tmp/in/text" "$tmp/in/text.geojson"
for file in text text.geojson; do
    expect 65 "text that never was a map: $file" render "$tmp/in/$file" -o a.png
    says "$file: not a map in a format that camber reads; name another file (camber info lists the formats)\$"
    lacks "$tmp/stderr" root
done
# Files that are known by their first bytes, and that GDAL does not open: each with its cure.
refused() { # NAME BYTES SAYS
    printf '%b' "$2" >"$tmp/in/$1"
    expect 65 "$1" render "$tmp/in/$1" -o a.png
    says "in/$1: $3\$"
}
refused a.osm.bz2 'BZh91AY&SY' "compressed with bzip2, .*; draw it by bzcat $tmp/in/a.osm.bz2 | camber render - -o OUT"
refused a.osm.xz '\3757zXZ\0' "compressed with xz, .*; draw it by xzcat $tmp/in/a.osm.xz | camber render - -o OUT"
refused a.osm.zst '\50\265\57\375' "compressed with zstd, .*; draw it by zstdcat $tmp/in/a.osm.zst | camber render - -o OUT"
refused a.zip 'PK\3\4' "a zip archive; name what is in it, as /vsizip/$tmp/in/a.zip/NAME .*"
refused a.o5m '\377\340\4o5m2\376' "OpenStreetMap's data as o5m, .*; convert it with osmium cat -o OUT.osm.pbf $tmp/in/a.o5m"
refused a.fgb 'fgb\2fgb\0\0\0\0\0' "version 2 of FlatGeobuf, .*; make it again from its source with ogr2ogr -f FlatGeobuf .*"
"$tool" info | grep -q Parquet || refused a.parquet 'PAR1\0\0\0\0PAR1' "Parquet, whose driver this GDAL lacks; convert it with ogr2ogr .*"
# A vector tile that has the layer "a" with a line: GDAL places tiles by their paths.
tile='\32\26x\2\12\1a\22\14\30\2\42\10\11dd\12\320\17\320\17\50\200\40'
refused a.pbf "$tile" 'a vector tile whose path does not say which one; name it ZOOM/COLUMN/ROW.pbf, or draw it by a style .*'
mkdir -p "$tmp/in/3/4"
printf '%b' "$tile" >"$tmp/in/3/4/2.pbf"
expect 0 "a vector tile of a set" render "$tmp/in/3/4/2.pbf" -o a.png --size 64x64
rm -f a.png
for type in '6 its tiles are MLT .*; make it again with MVT' '5 its tiles are pictures; camber reads vector tiles' \
    '7 its tiles are of type 7, which camber does not know; .*'; do
    refused a.pmtiles "PMTiles\3$(printf '\\0%.0s' {1..89})\1\1\\${type%% *}$(printf '\\0%.0s' {1..27})" "${type#* }"
done
# A parallel across the world, and a line that goes the short way, over the antimeridian.
echo '{"type":"MultiLineString","coordinates":[[[-180,0],[180,0]],[[-100,40],[100,40]]]}' >"$tmp/in/par.geojson"
expect 0 "lines across the world" render "$tmp/in/par.geojson" -o a.png --center 0,0 --zoom 0 --size 300x300 -v
says '^1 feature, 3 polylines, 6 points, '
says '^antimeridian: crossed 1 time; '
expect 0 "lines across the world, as JSON" render "$tmp/in/par.geojson" -o a.png -f --center 0,0 --zoom 0 --json
has "$tmp/stdout" '"antimeridian_splits": 1'
rm -f a.png
expect 65 "a folder" render "$tmp/in" -o a.png
expect 65 "no such layer" render "$osm" -o a.png --layer nope
expect 0 "one line" render "$tmp/in/line.geojson" -o a.png --size 64x64
lacks "$tmp/stderr" polyline # counts are for -v
expect 0 "one line, at length" render "$tmp/in/line.geojson" -o a.png -f --size 64x64 -v
says '^1 feature, 1 polyline, 2 points, '
lacks a.png OpenStreetMap # anyone's roads may have a key of theirs
lacks "$tmp/stderr" OpenStreetMap
rm -f a.png
# Lines that the style leaves out are told at length; where it leaves out everything, always.
rail=${line/highway/railway}
echo "{\"type\":\"FeatureCollection\",\"features\":[$line,$rail]}" >"$tmp/in/rail.geojson"
expect 0 "a line that the style leaves out" render "$tmp/in/rail.geojson" -o a.png --size 64x64 --style "$tmp/in/primary.json"
lacks "$tmp/stderr" '^camber: '
expect 0 "a line that the style leaves out, at length" render "$tmp/in/rail.geojson" -o a.png -f --size 64x64 -v --style "$tmp/in/primary.json"
says '^camber: info: style: no layer draws 1 of the 2 features$'
echo "{\"type\":\"FeatureCollection\",\"features\":[$rail,${line/primary/nothing of a road}]}" >"$tmp/in/undrawn.geojson"
expect 0 "lines that the style leaves out" render "$tmp/in/undrawn.geojson" -o a.png -f --size 64x64 --style "$tmp/in/primary.json"
says '^camber: warning: nothing is drawn: 2 lines of [0-9]* bytes read, but no layer of the style draws any of it: it reads highway; choose a style'
[ "$(grep -c warning "$tmp/stderr")" = 1 ] || fail "more than one warning"
rm -f a.png
point='{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,1]}}'
echo "{\"type\":\"FeatureCollection\",\"features\":[$line,$point]}" >"$tmp/in/mixed.geojson"
expect 0 "a line and a point" render "$tmp/in/mixed.geojson" -o a.png --size 64x64
lacks "$tmp/stderr" '^camber: '
expect 0 "a line and a point, at length" render "$tmp/in/mixed.geojson" -o a.png -f --size 64x64 -v --style "$tmp/in/primary.json"
says '^camber: info: .*left out what is no line .* of 1 features$'
if command -v python3 >/dev/null; then # a socket that keeps apart what was written at once: threads write, too
    python3 -c 'import socket, subprocess, sys
here, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
with subprocess.Popen(sys.argv[1:], stderr=there) as process:
    there.close()
    written = list(iter(lambda: here.recv(65536), b""))
sys.exit(process.returncode or not written or any(text.count(b"\n") != 1 or text[-1:] != b"\n" for text in written))' \
        "$tool" render "$tmp/in/mixed.geojson" -o a.png -f --size 64x64 -v || fail "a line is written in several parts"
fi
rm -f a.png
ring='[[0,0],[0.004,0],[0.004,0.004],[0,0.004]]' # its outline is closed, too
echo "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[$ring]}}" >"$tmp/in/open.geojson"
echo '{"version":8,"sources":{},"layers":[{"id":"a","type":"fill","paint":{"fill-outline-color":"#d00"}}]}' >"$tmp/in/outline.json"
expect 0 "an open ring" render "$tmp/in/open.geojson" --style "$tmp/in/outline.json" -o a.png -v
says '^camber: warning: .*1 rings of areas were not closed; they are now$'
says ' 2 polylines, 10 points,'
says '^areas: 1 ring closed$'
flat='[[0,0],[0.004,0.004],[0,0]]'
echo "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[$ring,$ring,$flat]}}" >"$tmp/in/odd.geojson"
expect 0 "an open ring, its hole and one without area" render "$tmp/in/odd.geojson" --style "$tmp/in/outline.json" -o a.png -f -v
says '^areas: 2 rings closed, 1 ring turned, 1 ring without area left out$'
expect 0 "rings that are counted" render "$tmp/in/odd.geojson" --style "$tmp/in/outline.json" -o a.png -f --json
has "$tmp/stdout" '"crossing_rings": 0' '"closed_rings": 2' '"turned_rings": 1' '"empty_rings": 1' '"open_relations": 0'
tie='[[0,0],[0.004,0.004],[0.004,0],[0,0.004],[0,0]]'
echo "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[$tie]}}" >"$tmp/in/tie.geojson"
expect 0 "a ring that crosses itself" render "$tmp/in/tie.geojson" --style "$tmp/in/outline.json" -o a.png -f -v
says '^areas: 1 self-crossing ring kept$'
odd='[[0,0],[0.004,0],[0.008,0],[0.004,0],[0.004,0.004],[0,0]],[[1,1],[1,1.01],[1.01,1],[1,1]]'
echo "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[$odd]}}" >"$tmp/in/odd.geojson"
expect 0 "a spike, and a hole outside" render "$tmp/in/odd.geojson" --style "$tmp/in/outline.json" -o a.png -f -v
says '^areas: 1 ring with a spike, 1 hole filled outside of areas$'
rm -f a.png
cat >"$tmp/in/roads.osm" <<'XML'
<osm version="0.6">
<node id="1" lat="1" lon="1"/><node id="2" lat="1.1" lon="1.1"/><node id="3" lat="1.2" lon="1"/>
<way id="10"><nd ref="1"/><nd ref="2"/><tag k="highway" v="primary"/><tag k="lit" v="yes"/></way>
<way id="11"><nd ref="2"/><nd ref="3"/><tag k="railway" v="rail"/></way>
</osm>
XML
# Attribute filters: any key of OpenStreetMap, and what its driver makes on demand; a warning where nothing passes.
for where in "lit = 'yes'" "\"highway\" = 'primary'" "osm_id = '10'" "other_tags LIKE '%lit%'" \
    "all_tags LIKE '%lit%'"; do
    expect 0 "filter $where" render "$tmp/in/roads.osm" -o a.png -f --size 64x64 --where "$where" -v
    says '^1 feature, '
    lacks "$tmp/stderr" warning
done
for where in "hihgway = 'primary':hihgway" 'highway = "primary":primary'; do
    expect 0 "filter ${where%:*}" render "$tmp/in/roads.osm" -o a.png -f --size 64x64 --where "${where%:*}"
    says "^camber: warning: .*nothing passes the filter .*: no feature has the tag \"${where#*:}\"; check it, and put values in single quotes"
    [ "$(grep -c warning "$tmp/stderr")" = 1 ] || fail "more than one warning"
done
expect 0 "filter of values that are not there" render "$tmp/in/roads.osm" -o a.png -f --size 64x64 --where "highway = 'x'"
says '^camber: warning: .*nothing passes the filter .*; check the values'
expect 0 "filter of tiles that nothing passes" render "$osm" -o a.png -f --size 64x64 --where "type = 'x'"
says '^camber: warning: .*nothing passes the filter'
rm -f a.png
expect 2 "filter of a field that is not there" render "$tmp/in/line.geojson" -o a.png --where "hihgway = 'primary'"
says '"hihgway" not recogni.ed as an available field; .*layer "line": highway$'
expect 2 "filter of tiles by a field that is not there" render "$osm" -o a.png --where "highway = 'primary'"
says 'layer "roads": .*type, name'
expect 0 "OpenStreetMap's own format" render "$tmp/in/roads.osm" -o a.png --size 64x64
has a.png '(c) OpenStreetMap contributors'
says '^(c) OpenStreetMap contributors$'
expect 0 "OpenStreetMap's own format, signed by the user" render "$tmp/in/roads.osm" -o a.png -f --size 64x64 --attribution Me
has a.png 'Me'
lacks a.png OpenStreetMap
expect 0 "OpenStreetMap's own format, not signed" render "$tmp/in/roads.osm" -o a.png -f --size 64x64 --attribution ''
lacks a.png Copyright
lacks "$tmp/stderr" OpenStreetMap
rm -f a.png
expect 0 "one line, tessellated" tessellate "$tmp/in/line.geojson" -o a.glb -v
says '^a.glb: [0-9]* vertices, [0-9]* triangles (strip), [0-9.]* [KB a-z]*, [0-9.]* s$'
says '^1 feature, 1 polyline, 2 points$'
adds_up
rm -f a.glb
run sh -c "head -c 500 /dev/urandom | '$tool' render - -o a.png"
name="random standard input"
verify 65
says 'standard input'

# ---- Styles ----

echo '{"version": 8, "layers": [' >"$tmp/in/cut.json"
echo '{"version": 8, "sources": {}, "layers": [{"id": "a", "type": "line", "source": "s", "paint": {"line-width": {}}}]}' \
    >"$tmp/in/type.json"
echo '{"version": 8, "sources": {}, "layers": [{"id": "a", "type": "line", "source": "s", "paint": {"line-color": 7}}]}' \
    >"$tmp/in/color.json"
expect 66 "no such style" render "$osm" -o a.png --style "$tmp/in/none.json"
expect 65 "style that is not JSON" render "$osm" -o a.png --style "$tmp/in/cut.json"
says 'cut.json'
expect 65 "all that is wrong with a style" style check --json "$tmp/in/type.json"
has "$tmp/stdout" '/layers/0/paint/line-width'
says '1 error; correct it'
echo '{"version": 8, "layers": [{"id": "a", "type": "fill"}, {"id": "b", "type": "fill-extrusion"}]}' >"$tmp/in/fill.json"
expect 0 "a style that is right" style check "$tmp/in/fill.json"
says '1 layer of type fill: drawn'
says '1 layer of type fill-extrusion: not drawn'
echo '{"expression": ["*", 2, ["get", "w"]], "inputs": [[{}, {"properties": {"w": 1.5}}], [{}, {}]]}' >"$tmp/in/double.json"
echo '{"expression": ["+", "a"]}' >"$tmp/in/wrong.json"
expect 0 "what an expression is" style eval "$tmp/in/double.json"
has "$tmp/stdout" '"type":"number".*"outputs":\[3,{"error":'
expect 0 "an expression that does not compile" style eval "$tmp/in/wrong.json"
has "$tmp/stdout" '"result":"error".*"key":"\[1\]"'
expect 65 "no expression" style eval "$tmp/in/fill.json"
expect 65 "an expression that is not JSON" style eval "$tmp/in/cut.json"
expect 66 "an expression by a style's name" style eval roads
expect 66 "no such expression" style eval "$tmp/in/none.json"
expect 2 "nothing to evaluate" style eval
expect 65 "width of a wrong type" render "$osm" -o a.png --style "$tmp/in/type.json"
says '/layers/0/paint/line-width'
expect 65 "colour of a wrong type" render "$osm" -o a.png --style "$tmp/in/color.json"
says '/layers/0/paint/line-color'
expect 65 "style that is a folder" render "$osm" -o a.png --style "$tmp/in"

layers='"layers": [{"id": "a", "type": "line", "source": "s", "paint": {"line-width": 3}}]'
echo "{\"version\": 8, \"center\": [1.5, 1.5], \"zoom\": 4, \"sources\": {\"s\": {\"type\": \"geojson\", \"data\": \"line.geojson\"}}, $layers}" >"$tmp/in/own.json"
expect 0 "a style with its own source" render --style "$tmp/in/own.json" -o a.png --size 64x64 --json
has "$tmp/stdout" '"features": 1'
is_png a.png 64 64
rm -f a.png
# Lines that lie in one place: a dot where caps are round, nothing where they are butt, at any zoom.
place='{"type":"Feature","properties":{"highway":"residential"},"geometry":{"type":"LineString","coordinates":[[5,5],[5,5]]}}'
echo "$place" >"$tmp/in/place.geojson"
echo "${place/\[\[5,5\],\[5,5\]\]/[[0,90],[0,89]]}" >"$tmp/in/pole.geojson"
for cap in butt round; do
    echo '{"version": 8, "sources": {}, "layers": [{"id": "l", "type": "line", "layout": {"line-cap": "'$cap'"},
        "paint": {"line-width": 9}}]}' >"$tmp/in/$cap.json"
done
for at in "" "--center 5,5 --zoom 22" "--center 5,5 --zoom 24"; do
    for cap in butt round; do
        expect 0 "a place, $cap, ${at:-fitted}" render "$tmp/in/place.geojson" --style "$tmp/in/$cap.json" -qfo $cap.png \
            --size 64x64 $at
    done
    cmp -s butt.png round.png && fail "no dot"
    expect 0 "a place without a dot, ${at:-fitted}" render "$tmp/in/line.geojson" --style "$tmp/in/butt.json" -qfo none.png \
        --size 64x64 --center 50,50 --zoom 22
    cmp -s butt.png none.png || fail "a dot with butt caps"
done
expect 0 "a line beyond the pole" render "$tmp/in/pole.geojson" --style "$tmp/in/round.json" -qfo pole.png --size 64x64
cmp -s round.png pole.png || fail "no dot"
expect 0 "a place, tessellated" tessellate "$tmp/in/place.geojson" -qfo a.glb
for verb in compare validate bench; do
    expect 0 "a place: $verb" $verb "$tmp/in/place.geojson" -q --size 64x64
done
rm -f ./*.png ./*.glb

sed 's/line.geojson/none.geojson/' "$tmp/in/own.json" >"$tmp/in/gone.json"
expect 66 "a style whose source is not there" render --style "$tmp/in/gone.json" -o a.png
says '/gone.json: /sources/s: .*/none.geojson: no such file; check the path in the style'
sed 's/line.geojson/text/' "$tmp/in/own.json" >"$tmp/in/passwd.json"
expect 65 "a style whose source is text" render --style "$tmp/in/passwd.json" -o a.png
lacks "$tmp/stderr" root
# Nothing of a source reads: that is bad input whatever the source is, and not silenced by -q.
sed 's/line.geojson/words.geojson/' "$tmp/in/own.json" >"$tmp/in/words.json"
expect 65 "a style whose GeoJSON has no feature that reads" render --style "$tmp/in/words.json" -qo a.png
says 'source "s": no feature can be read: /features/0: '
echo '<html>404</html>' >"$tmp/in/0-0-0.mvt"
echo '{"version": 8, "sources": {"s": {"type": "vector", "maxzoom": 0, "tiles": ["{z}-{x}-{y}.mvt"]}}, "layers": [{"id": "a",
    "type": "line", "source": "s", "source-layer": "a"}]}' >"$tmp/in/html.json"
expect 65 "a style whose tiles are none" render --style "$tmp/in/html.json" -qo a.png
says 'source "s": no feature can be read: tile 0/0/0: '
if python3 -c 'import sqlite3' 2>/dev/null; then
    python3 -c 'import sqlite3, sys
d = sqlite3.connect(sys.argv[1])
d.execute("create table metadata (name text, value text)")
d.execute("create table tiles (zoom_level integer, tile_column integer, tile_row integer, tile_data blob)")
d.execute("insert into tiles values (0, 0, 0, ?)", (b"<html>404</html>",))
d.commit()' "$tmp/in/html.mbtiles"
    expect 65 "MBTiles whose tiles are none" render "$tmp/in/html.mbtiles" -qo a.png
    says 'html.mbtiles: no feature can be read: tile 0/0/0: '
fi
# Numbers that JSON has no word for, and a byte order mark: INPUT and a style's source read the same of them.
for odd in 2 NaN Infinity -Infinity 1e400; do
    { printf '\357\273\277'; sed "s/\[2,2\]/[1.5,$odd],[2,2],[3,1]/" "$tmp/in/line.geojson"; } >"$tmp/in/odd.geojson"
    sed 's/line.geojson/odd.geojson/' "$tmp/in/own.json" >"$tmp/in/odd.json"
    expect 0 "a style's source with $odd" render --style "$tmp/in/odd.json" -fo a.png --size 64x64 --bbox 0,0,4,4
    [ "$odd" = 2 ] || says 'warning: .*1 points are not numbers'
    expect 0 "INPUT with $odd" render "$tmp/in/odd.geojson" --style "$tmp/in/odd.json" -fo b.png --size 64x64 --bbox 0,0,4,4
    [ "$odd" = 2 ] || says 'warning: .*1 points are not numbers'
    cmp -s a.png b.png || fail "two pictures"
done
rm -f a.png b.png
{ printf '\357\273\277'; cat "$tmp/in/own.json"; } >"$tmp/in/mark.json"
expect 0 "a style with a byte order mark" style check "$tmp/in/mark.json"
sed 's|line.geojson|https://example.org/a.geojson|' "$tmp/in/own.json" >"$tmp/in/url.json"
expect 65 "a style whose source is elsewhere" render --style "$tmp/in/url.json" -o a.png
says '/url.json: /sources/s: https://example.org'
# A sprite that says it is 60000 x 60000 px, with no pixels.
printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\352`\0\0\352`\b\006\0\0\0\200\322uB\0\0\0\0IDAT5\257\006\036\0\0\0\0IEND\256B`\202' >"$tmp/in/vast.png"
echo '{"a": {"x": 0, "y": 0, "width": 60000, "height": 60000, "pixelRatio": 1}}' >"$tmp/in/vast.json"
sed 's/"version": 8,/& "sprite": "vast",/; s/"line-width": 3/"line-pattern": "a"/' "$tmp/in/own.json" >"$tmp/in/pattern.json"
expect 65 "a style whose sprite is too large" render --style "$tmp/in/pattern.json" -o a.png
says '60000 x 60000 px are too large; cut it'
sed 's/"vast"/"none"/' "$tmp/in/pattern.json" >"$tmp/in/nosprite.json"
expect 66 "a style whose sprite is not there" render --style "$tmp/in/nosprite.json" -o a.png
says 'sprite "default": .*/none.png: no such file; check the path in the style'
expect 66 "nor its large form" render --style "$tmp/in/nosprite.json" -o a.png --ratio 2
sed 's|"vast"|"https://example.org/sprite"|' "$tmp/in/pattern.json" >"$tmp/in/farsprite.json"
expect 0 "a style whose sprite is elsewhere" render --style "$tmp/in/farsprite.json" -o a.png --size 64x64
says '^camber: warning: sprite "default": https://example.org/sprite is a network address'
rm -f a.png
expect 0 "the built-in style by its name" render "$tiger" --style city --theme dark -qo named.png --size 64x64
expect 0 "the built-in style" render "$tiger" --theme dark -qo builtin.png --size 64x64
cmp -s named.png builtin.png || fail "city is not the built-in style"
expect 0 "roads alone" render "$tiger" --style roads --theme dark -qo roads.png --size 64x64
cmp -s roads.png builtin.png || fail "roads look otherwise in the built-in style"
echo '{"type": "Feature", "properties": {"class": "A Road", "building": "no"},
    "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, 1], [2, 0]]}}' >"$tmp/in/class.geojson"
for style in roads city; do
    expect 0 "lines of no class, in $style" render "$tmp/in/class.geojson" --style "$style" -fqo "$style.png" --size 64x64
done
cmp -s roads.png city.png || fail "what the city knows of areas hides lines of no class"
rm -f named.png builtin.png roads.png city.png
expect 0 "a style that ships" style check openmaptiles
expect 66 "no style of that name" render "$tiger" --style streets -o a.png
says 'city, roads, openmaptiles, transit'
expect 66 "a style that ships, without its tiles" render --style openmaptiles --theme dark -o a.png
says 'openmaptiles, [a-z]*: /sources/openmaptiles: openmaptiles.mbtiles: no such file; tilemaker makes it'
expect 66 "a style that ships, without its lines" render --style transit -o a.png
says 'transit.*: /sources/transit: transit.geojson: no such file; osmium and transit-lines.py make it'
cp "$tmp/in/own.json" roads
expect 2 "a file goes before a style that ships" render "$tiger" --style roads --theme dark -o a.png
rm -f roads
expect 2 "a filter on a style's own source" render --style "$tmp/in/own.json" -o a.png --where "a = 1"
says 'INPUT'

# ---- Output ----

expect 73 "no such folder" render "$osm" -o none/a.png
expect 73 "a file as a folder" render "$osm" -o "$tmp/in/empty/a.png"
mkdir folder.png
expect 73 "a folder" render "$osm" -o folder.png
expect 73 "a folder, forced" render "$osm" -o folder.png -f
rmdir folder.png
expect 73 "a name that is too long" render "$osm" -o "$(printf 'a%.0s' $(seq 300)).png"
if [ -w /dev/full ]; then
    expect 73 "a device, not forced" render "$osm" -o /dev/full --format png
    expect 74 "a full disk" render "$osm" -o /dev/full --format png -f
    [ -c /dev/full ] || fail "the device is gone"
    expect 74 "a full disk, png8" render "$osm" -o /dev/full --format png8 -f
    expect 74 "a full disk, GLB" tessellate "$osm" -o /dev/full --format glb -f
    for words in "render $osm -o - --size 64x64" "render $osm -o a.png -f --json" "info" "info --json" "--help"; do
        run sh -c "'$tool' $words >/dev/full"
        name="standard output is full: $words"
        [ "$status" = 74 ] || fail "exit status $status, not 74"
        rm -f a.png
    done
fi
mkdir "$tmp/small"
if mount -t tmpfs -o size=32k none "$tmp/small" 2>/dev/null; then
    expect 74 "a small disk" render "$osm" -o "$tmp/small/a.png" --size 2000x2000
    [ -z "$(ls -A "$tmp/small")" ] || fail "left behind: $(ls -A "$tmp/small")"
    expect 74 "a small disk, GLB" tessellate "$osm" -o "$tmp/small/a.glb"
    [ -z "$(ls -A "$tmp/small")" ] || fail "left behind: $(ls -A "$tmp/small")"
else
    echo "skipped: a small disk: no right to mount one"
fi
name="a reader that goes"
"$tool" render "$osm" -o - --size 2000x2000 2>"$tmp/stderr" | head -c 10 >/dev/null
status=${PIPESTATUS[0]}
[ "$status" = 74 ] || fail "exit status $status, not 74"
[ "$(wc -l <"$tmp/stderr")" = 1 ] || fail "$(wc -l <"$tmp/stderr") lines"

# A file that is read is not written, by whatever name.
cp "$tmp/in/line.geojson" both.geojson
cp "$tmp/in/own.json" both.json
cp "$tmp/in/lines.bin" both.bin
gzip -c both.geojson >both.geojson.gz
ln -s both.geojson link.png
ln both.geojson hard.png
ln -s "$tmp/out" "$tmp/in/out"
intact() { # WHAT ARGUMENT...: status 2 with and without -f
    local what=$1 force
    shift
    for force in -q -f; do
        expect 2 "$what is both, $force" "$@" $force
        says ': is both .* and .*; name another '
    done
    cmp -s both.geojson "$tmp/in/line.geojson" || fail "the input has changed"
}
intact INPUT render both.geojson -o both.geojson --format png
intact "INPUT by a link" render both.geojson -o link.png
intact "INPUT by a hard link" render both.geojson -o hard.png
intact "INPUT by another folder" tessellate "$tmp/in/out/both.geojson" -o both.geojson --format glb
intact "the second INPUT" render "$tiger" link.png -o both.geojson --format png
intact "an archive's file" render "/vsigzip/$PWD/both.geojson.gz" -o both.geojson.gz --format png
intact "a style" render "$tiger" --style both.json -o both.json --format png
intact "polylines" bench --polylines both.bin -o both.bin --format png
intact "polylines and their dump" bench --polylines both.bin --dump both.bin
intact "polylines and JUnit" validate --polylines both.bin --junit both.bin
intact "one file for two outputs" bench --polylines "$tmp/in/lines.bin" -o two.png --dump ./two.png
cp both.geojson check-0001.png
intact "an INPUT among pictures" validate check-0001.png --pictures .
rm check-0001.png
for part in shx dbf prj DBF; do
    cp both.geojson roads.shp
    cp both.geojson roads.$part
    intact "a part of a Shapefile, $part," render roads.shp -o roads.$part --format png
    rm roads.$part
done
expect 0 "a picture beside INPUT" render roads.shp -qo roads.png --size 64x64
rm roads.shp roads.png
name="standard input is OUT"
run sh -c "'$tool' render - -fo link.png <both.geojson"
verify 2
name="standard output is INPUT"
run sh -c "'$tool' render both.geojson -o - 1<>both.geojson"
verify 2
cmp -s both.geojson "$tmp/in/line.geojson" || fail "the input has changed"
rm -f both.* link.png hard.png "$tmp/in/out"

# ---- The system's limits ----

[ -z "$drivers" ] || export CAMBER_CPU=$drivers
limited() { # LIMIT ARGUMENT...: under ulimit LIMIT, without descriptors of whoever runs this test
    run bash -c 'exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-; ulimit -c 0 && ulimit '"$1"' && exec "$@"' - "$tool" "${@:2}"
}
for size in 64 100 200 1024; do
    for verb in info "render $osm -fo small.png --size 64x64"; do
        name="a stack of $size KB: $verb"
        # shellcheck disable=SC2086
        limited "-s $size" $verb
        verify 0
    done
done
rm -f small.png
for count in 4 5 6 7 12; do
    for verb in info "render $osm -o a.png" "bench $osm"; do
        name="$count descriptors: $verb"
        # shellcheck disable=SC2086
        limited "-n $count" $verb
        verify 74
        says 'too many open files; raise ulimit -n$'
    done
done
name="7 descriptors without a driver"
limited "-n 7" style check roads
verify 0
for verb in "render $osm -o a.png" "render $osm -o - --size 900x900" "tessellate $osm -o a.glb"; do
    name="files of 10 KB: $verb"
    # shellcheck disable=SC2086
    limited "-f 10" $verb
    verify 74
    says ': File too large; raise the limit of a file.s size (ulimit -f)'
done
name="a copy of 10 KB"
run bash -c "ulimit -f 10; '$tool' render - -o a.png <'$osm'"
verify 74
says '^camber: standard input: cannot be copied to .*File too large.*ulimit -f'
if [ -n "$faulty" ]; then # a sanitizer takes more for itself
    name="100 MB of memory"
    limited "-v 100000" render "$osm" -o a.png
    verify 70
    says "memory: .* address space .*raise the limit (ulimit -v)"
fi
for verb in "render - -o a.png" "tessellate - -o a.glb" "compare -" "bench --polylines -" "style check -" "style eval -" \
    "render $tiger --style - -o a.png"; do
    name="standard input is closed: $verb"
    run sh -c "'$tool' $verb <&-"
    verify 74
    says '^camber: standard input: is closed; '
    name="standard input is a folder: $verb"
    run sh -c "'$tool' $verb <'$tmp'"
    verify 65
    says '^camber: standard input: is a folder; '
done
name="standard output is closed"
run sh -c "'$tool' render '$tiger' -o closed.png --size 64x64 --json >&-"
[ "$status" = 74 ] || fail "exit status $status, not 74"
is_png closed.png 64 64
rm closed.png

# Drivers keep their files out of the folder that the tool is run in.
mkdir "$tmp/bare"
for folders in "XDG_CACHE_HOME=rel HOME=$tmp/home" "XDG_CACHE_HOME= HOME=rel" "-u XDG_CACHE_HOME -u HOME"; do
    if [[ $folders != *"$tmp"* ]] && [ -e /tmp/pocl ] && [ ! -O /tmp/pocl ]; then
        echo "skipped: a cache of $folders: PoCL, which has no home then, would take /tmp/pocl, which is another user's"
        continue
    fi
    for draw in cl gl; do
        # shellcheck disable=SC2086
        run env -C "$tmp/bare" -u POCL_CACHE_DIR $folders "$tool" render "$tmp/in/line.geojson" -qo - --size 64x64 --draw $draw
        name="a cache of $folders, $draw"
        verify 0
        [ -z "$(ls -A "$tmp/bare")" ] || fail "left in the working folder: $(ls -A "$tmp/bare")"
        rm -rf "$tmp/bare" && mkdir "$tmp/bare"
    done
done
# GDAL's nodes, more than it holds in memory: in a folder where nothing can be made it would have nowhere to put them.
awk 'BEGIN { print "<osm version=\"0.6\">"
    for (i = 1; i <= 8000; i++) printf "<node id=\"%d\" lat=\"%.4f\" lon=\"1\"/>\n", i * 1000, 1 + i / 10000
    print "<way id=\"1\"><nd ref=\"1000\"/><nd ref=\"2000\"/><tag k=\"highway\" v=\"primary\"/></way></osm>" }' >"$tmp/in/nodes.osm"
run env -C /proc -u TMPDIR OSM_MAX_TMPFILE_SIZE=1 "$tool" render "$tmp/in/nodes.osm" -o "$tmp/out/nodes.png" --size 64x64 -v
name="no TMPDIR"
verify 0
says '^1 feature, '
rm -f nodes.png

# ---- Devices ----

expect 69 "an unknown device" render "$osm" -o a.png --device 'no such device'
for verb in "render $osm -o a.png" "tessellate $osm -o a.glb" validate; do
    name="no OpenCL platform: $verb"
    # shellcheck disable=SC2086
    run env OCL_ICD_VENDORS="$tmp/empty" OPENCL_VENDOR_PATH="$tmp/empty" "$tool" $verb
    verify 69
done

# ---- Signals ----

# Job control: without it a shell starts background jobs with SIGINT ignored.
set -m
ulimit -c 0
mkfifo "$tmp/in/fifo"
# Until the job is the tool: a shell would remove $tmp if the signal reached it before.
await_tool() {
    while [ "/proc/$job/exe" -ef "$BASH" ]; do :; done
}
# Starts the tool on standard input that does not end: OUT and the copy have been begun. job is its number.
begin() { # COMMAND...
    "$@" "$tool" render - -o a.png <"$tmp/in/fifo" 2>"$tmp/stderr" &
    job=$!
    exec 3>"$tmp/in/fifo"
    head -c 200000 "$osm" >&3
    until [ -n "$(ls -A "$TMPDIR")" ]; do
        kill -0 $job 2>/dev/null || break
        sleep 0.1
    done
    [ -n "$(ls -A "$tmp/out")" ] || fail "no output was begun"
}
ended() { # STATUS
    wait $job 2>/dev/null
    status=$?
    exec 3>&-
    checks=$((checks + 1))
    [ "$status" = "$1" ] || fail "exit status $status, not $1"
    [ -z "$(ls -A "$tmp/out")$(ls -A "$TMPDIR")" ] || fail "left behind: $(ls -A "$tmp/out" "$TMPDIR")"
    rm -rf -- .camber-* "$TMPDIR"/.camber-*
}
for signal in HUP INT QUIT USR1 USR2 ALRM TERM VTALRM PROF XCPU PWR; do
    name="SIG$signal while it reads"
    begin env
    kill -$signal $job
    ended $((128 + $(kill -l $signal)))
done
# LLVM's own handler, where it has just been installed, drops one that does not come from abort().
name="SIGABRT while it reads"
begin env
while kill -ABRT $job 2>/dev/null; do
    sleep 0.2
done
ended 134
name="SIGHUP under nohup"
begin nohup
kill -HUP $job
sleep 0.2
kill -0 $job 2>/dev/null || fail "has ended"
kill -TERM $job
ended 143
for delay in 0 0.02 0.05 0.1 0.2; do
    name="SIGHUP after $delay s"
    "$tool" render - -o a.png <"$tmp/in/fifo" 2>"$tmp/stderr" &
    job=$!
    exec 3>"$tmp/in/fifo"
    await_tool
    sleep $delay
    kill -HUP $job
    ended 129
done
name="a limit of CPU time"
# The shell takes most of that second, in hundredths, so that any machine's tool needs more than is left.
run bash -c "ulimit -S -t 1
    until read -ra stat </proc/\$\$/stat && [ \$((stat[13] + stat[14])) -ge 85 ]; do :; done
    exec '$tool' render '$osm' -o a.png --size 20000x20000 --threads 1"
[ "$status" = 152 ] || fail "exit status $status, not 152"
[ -z "$(ls -A)" ] || fail "left behind: $(ls -A)"
name="a killed run's copy"
begin env
kill -KILL $job
wait $job 2>/dev/null
exec 3>&-
rm -f -- .camber-*
[ -n "$(ls -A "$TMPDIR")" ] || fail "it has none"
begin env
[ "$(ls -A "$TMPDIR" | wc -l)" = 1 ] || fail "the next run leaves it: $(ls -A "$TMPDIR")"
# A run beside leaves a copy that is in use.
"$tool" render - -o /dev/null --format png -fq --size 64x64 <"$osm" || fail "exit status $? beside"
[ "$(ls -A "$TMPDIR" | wc -l)" = 1 ] || fail "another run takes it: $(ls -A "$TMPDIR")"
kill -TERM $job
ended 143
if [ -n "$faulty" ]; then
    for fault in abort:134 segv:139; do
        name="a driver's ${fault%:*}"
        run env LD_PRELOAD="$faulty${LD_PRELOAD:+:$LD_PRELOAD}" CAMBER_FAULT="${fault%:*}" "$tool" render "$osm" -o a.png --size 64x64
        [ "$status" = "${fault#*:}" ] || fail "exit status $status, not ${fault#*:}"
        [ -z "$(ls -A)" ] || fail "left behind: $(ls -A)"
        rm -rf -- .camber-*
    done
fi
name="SIGINT in the middle"
for delay in 0.02 0.05 0.1 0.15 0.2 0.3 0.5; do
    "$tool" render "$osm" -o a.png --size 4000x4000 2>"$tmp/stderr" &
    job=$!
    await_tool
    sleep $delay
    kill -INT $job 2>/dev/null
    wait $job
    status=$?
    case $status in
    0) is_png a.png 4000 4000 ;;
    130) ;;
    *) fail "exit status $status after $delay s" ;;
    esac
    rm -f a.png
    [ -z "$(ls -A)" ] || fail "left behind after $delay s: $(ls -A)"
    rm -rf -- .camber-*
done
set +m

echo "$checks runs, $failures failures"
[ "$failures" = 0 ]
