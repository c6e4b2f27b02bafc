#!/bin/bash
# Breaks kernels, shaders and join maths on purpose, one line at a time, and runs `camber validate` on each build: it
# must end with 1 and name a check that failed, or be ended by what the broken kernel did.
#
#   test_mutations.sh SOURCES [TEXT]               by hand: the rows whose file or words contain TEXT; all without it
#   test_mutations.sh SOURCES --texts              whether each row's old text is still in its file; a second
#   test_mutations.sh SOURCES --build FOLDER       builds the sources as they are, and validates them once
#   test_mutations.sh SOURCES --run FOLDER K/N     every N-th row, from the K-th on, in that build
#   test_mutations.sh SOURCES --run FOLDER changed the rows of the files that CAMBER_CHANGED names, one a line
#
# One run at a time may use FOLDER. kernels/join.h and kernels/cull.h are compiled into kernels and CPU twin alike, so
# that pixels and the window tell; kernels/stroke*, pitch.h, features.h and images.h into shaders as well.
set -u
sources=$1
verb=${2:-}
only= share=1/1
case $verb in
--texts | --build) folder=${3:-} ;;
--run) folder=$3 share=$4 ;;
*) only=$verb verb='' folder='' ;;
esac
row=0
tmp=$(mktemp -d) || exit 1
trap 'rm -rf "$tmp"' EXIT
work=${folder:-$tmp} # has the sources, their build, and what the first validation found
# Drivers keep their caches apart from those of other tests.
export XDG_CACHE_HOME=$tmp/cache POCL_CACHE_DIR=$tmp/pocl
# PoCL is told not to optimise: most rows are told within the first checks, and kernels take longer to compile than to run.
export POCL_EXTRA_BUILD_FLAGS=-cl-opt-disable
mkdir "$POCL_CACHE_DIR"
mkfifo "$tmp/pipe"
caught=0
failures=0

fail() {
    failures=$((failures + 1))
    echo "FAILED: $*"
}

# The tool reads its kernels from the build tree: one that no twin shares is written there, and nothing is compiled here.
build() { # [FILE THAT HAS CHANGED]
    local targets=(camber_tool)
    [[ ${1:-} != kernels/*.cl ]] || targets=(src/tessellate.cl src/cull.cl src/arc_length.cl src/offset.cl src/raster.cl)
    # The row before left a file to be built again.
    [ "${1:-}" = "$restored" ] || [[ $restored = kernels/*.cl ]] || targets=(camber_tool src/{tessellate,cull,arc_length,offset,raster}.cl)
    ninja -C "$work/build" "${targets[@]}" >"$tmp/build.log" 2>&1
}

# Puts a file back. It is newer than what was made of it, so that the next build makes that again.
restored=
restore() { # FILE
    restored=$1
    cp "$sources/$1" "$work/sources/$1"
}

# Runs validate; its report is in $tmp/tap. One back end and half of the windows tell as much, and a row names the group of
# checks that tells, so that the others need not run.
backend=auto
drawer=()
level=(--full)
group=
run_validate() { # ARGUMENT...
    local drawn=(--backend "$backend") chosen=()
    [ ${#drawer[@]} = 0 ] || drawn=("${drawer[@]}")
    [ -z "$group" ] || chosen=(--only "$group")
    exec "$work/build/src/camber" validate "${level[@]}" "${chosen[@]}" -v --windows 12 "${drawn[@]}" "$@" 2>"$tmp/stderr"
}
validate() { (run_validate "$@" >"$tmp/tap"); }

# As validate, but no further than the first check that fails: a row needs one. Ends with 1 there too. (sed -u reads as
# lines come; an awk may wait for more.)
validate_until_failure() {
    local process
    run_validate "$@" >"$tmp/pipe" &
    process=$!
    if ! sed -u -n 'p; /^not ok/,/^  [.][.][.]$/ { /^  [.][.][.]$/ q1 }' <"$tmp/pipe" >"$tmp/tap"; then
        kill "$process" 2>"$tmp/killed"
        wait "$process" 2>"$tmp/killed"
        return 1
    fi
    wait "$process" 2>"$tmp/killed"
}

# A failure leaves a picture that the report names, JUnit's failures, and JSON with what differs.
reports=()
look_at_failures() { # FILE METHOD
    local picture member
    picture=$(sed -n 's/^  picture: "\(.*\)"$/\1/p' "$tmp/tap" | head -n 1)
    [ "$(head -c 4 "${picture:-/dev/null}" | tail -c 3)" = PNG ] || fail "$1: no picture: '$picture'"
    [ "$(find "$tmp/pictures" -name '*.png' | wc -l)" -le 32 ] || fail "$1: more than 32 pictures"
    [ "$(grep -c '<failure ' "$tmp/junit.xml")" = "$(grep -c '^not ok' "$tmp/tap")" ] || fail "$1: JUnit has other failures"
    (run_validate --method "$2" --json >"$tmp/json")
    [ $? = 1 ] || fail "$1: another exit status with --json"
    for member in '"stage": "' '"polyline": [0-9]' '"point": [0-9]' '"field": "' '"got": ' '"expected": ' '"difference": "'; do
        grep -q "$member" "$tmp/json" || fail "$1: the JSON lacks $member"
    done
}

is_chosen() { # FILE
    case $share in
    changed) grep -qxF "$1" <<<"${CAMBER_CHANGED:-}" ;;
    *) [ $((row % ${share#*/})) = $((${share%/*} % ${share#*/})) ] ;;
    esac
}

# mutant METHOD FILE WHAT-IT-BREAKS OLD NEW: replaces the first OLD in FILE. METHOD is what validate is told to check.
mutant() {
    local method=$1 file=$2 what=$3 old=$4 new=$5 text
    case "$file $what" in *"$only"*) ;; *) return ;; esac
    row=$((row + 1))
    is_chosen "$file" || return
    text=$(cat "$sources/$file" && printf x) || { fail "$file: cannot be read"; return; }
    text=${text%x}
    if [ "${text/"$old"/}" = "$text" ]; then
        fail "$file: $what: the old text is gone: $old"
        return
    fi
    [ "$verb" != --texts ] || { caught=$((caught + 1)); return; }
    printf '%s' "${text/"$old"/"$new"}" >"$work/sources/$file"
    if build "$file"; then
        rm -rf "$tmp/pictures" "$tmp/junit.xml"
        local status first
        if [ ${#reports[@]} = 0 ]; then
            validate_until_failure --method "$method"
        else
            validate --method "$method" "${reports[@]}"
        fi
        status=$?
        first=$(grep -m 1 '^not ok' "$tmp/tap")
        if [ "$status" -gt 128 ] && [ ${#reports[@]} = 0 ]; then
            # A broken kernel may leave unwritten whatever lay there: the next one may go anywhere.
            caught=$((caught + 1))
            echo "caught: $file: $what: ended by signal $((status - 128))"
        elif [ "$status" = 1 ] && [ -n "$first" ]; then
            caught=$((caught + 1))
            echo "caught: $file: $what"
            echo "    ${first#not ok }"
            grep -m 1 '^  message: ' "$tmp/tap" | sed 's/^ */    /'
            [ ${#reports[@]} = 0 ] || look_at_failures "$file" "$method"
        else
            fail "$file: $what: not caught: exit status $status; $(head -c 300 "$tmp/stderr")"
        fi
    else
        fail "$file: $what: does not build: $(grep -m 3 -i error "$tmp/build.log")"
    fi
    restore "$file"
}

# ---- The build that is broken ----

build_whole() {
    local part
    rm -rf "$work/sources" "$work/build"
    mkdir -p "$work/sources"
    for part in .ci CMakeLists.txt LICENSE README.md CHANGELOG.md kernels shaders src bench tests; do
        cp -rp "$sources/$part" "$work/sources/" || exit 1
    done
    # Nearly all of the time is compilers': C that takes half as long to compile is fast enough.
    local options=(-DCAMBER_MAP=OFF -DCAMBER_TESTS=OFF -DCAMBER_WARM=OFF -DCAMBER_KERNEL_FILES=ON
        -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_C_FLAGS_RELWITHDEBINFO=-O1)
    if ! cmake -S "$work/sources" -B "$work/build" -G Ninja "${options[@]}" >"$tmp/build.log" 2>&1 || ! build; then
        tail -20 "$tmp/build.log"
        echo "FAILED: the sources do not build"
        exit 1
    fi
}

# A check that fails anyway would tell of every row. All of --full would take eight minutes of kernels that are not
# optimised: the other lanes, and one scene by the other methods, stand for it here; test_validate runs it with
# kernels that are.
validate_whole() {
    local status=0
    level=(--full)
    drawer=(--draw cl) group=pictures
    validate --method strip || status=$?
    drawer=() group=turns
    [ "$status" != 0 ] || validate --method kite || status=$?
    [ "$status" != 0 ] || validate --method fan || status=$?
    level=() group=
    [ "$status" != 0 ] || validate --method strip || status=$?
    case $status in
    0) echo "passes: the sources as they are, $(sed -n 's/^1\.\.//p' "$tmp/tap") checks" ;;
    69) echo "skipped: $(cat "$tmp/stderr")"; exit 77 ;;
    *)
        grep -m 3 -A 4 '^not ok' "$tmp/tap"
        cat "$tmp/stderr"
        echo "FAILED: the sources as they are do not pass"
        exit 1
        ;;
    esac
    if ! grep -q ': pixels, on' "$tmp/tap"; then
        echo "skipped: no GL back end: $(grep -m 1 SKIP "$tmp/tap")"
        exit 77
    fi
    if grep -q ': pixels, on .*EGL$' "$tmp/tap"; then backend=egl; else backend=osmesa; fi
    echo "$backend" >"$work/backend"
}

case $verb in
--texts) ;;
--run) backend=$(cat "$work/backend") || { echo "skipped: no build that passes in $work"; exit 77; } ;;
*)
    rm -f "$work/backend"
    build_whole
    validate_whole
    [ "$verb" != --build ] || exit 0
    ;;
esac
level=(--full)

# ---- Kernels: the twin tells ----

group=': meshes'
mutant strip kernels/classify.cl "a neighbour off by one" 'x_before[i - 1]' 'x_before[i]'
mutant strip kernels/classify.cl "only first points are ends" 'point & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST)' \
    'point & CAMBER_POINT_FIRST'
mutant strip kernels/scan.cl "runs that begin half as far" 'total[from][lane] - own' '(total[from][lane] - own) / 2u'
mutant kite kernels/scan.cl "a point in its neighbour's place" 'joins_before[first + n - 1]' 'joins_before[first + n]'
reports=(--pictures "$tmp/pictures" --junit "$tmp/junit.xml")
mutant strip kernels/emit.cl "a missing break" '? CAMBER_RECORD_BREAK | (' '? ('
reports=()
mutant strip kernels/emit.cl "a start that is placed like an end" ': CAMBER_RECORD_START | point' ': point'
mutant strip kernels/classify.cl "a line that forgets its ends" 'info_before[i - 1]' 'info_before[i]'
mutant kite kernels/emit.cl "a triangle that winds the other way" 'put_triangle(indices + 3, sr, e + 1, e)' \
    'put_triangle(indices + 3, sr, e, e + 1)'
mutant fan kernels/emit.cl "a fan from the inner edge" 'outer > 0.0f ? CAMBER_CORNER_IN_LEFT : CAMBER_CORNER_IN_RIGHT' \
    'outer < 0.0f ? CAMBER_CORNER_IN_LEFT : CAMBER_CORNER_IN_RIGHT'

mutant strip kernels/offset_emit.cl "slots that begin one too far" 'writer.at = bases[chunk] + 1u' 'writer.at = bases[chunk] + 2u'
mutant strip kernels/offset_clip.cl "what is left of a neighbour" 'camber_offset_clip_of(&source_line, slot)' \
    'camber_offset_clip_of(&source_line, slot > 1u ? slot - 1u : slot)'

# ---- Offsets, which kernels and twin share: where points lie tells ----

group='offset lines'
mutant strip kernels/offset.h "to the other side" 'segment->ux * along - segment->uy * offset' 'segment->ux * along + segment->uy * offset'
mutant strip kernels/offset.h "bends that hide nothing" 'return room;' 'return 0.0f;'
mutant strip kernels/offset_clip.h "lines that hide nothing" 'if (lo >= segment->length || hi <= 0.0f)' 'if (lo < segment->length)'
mutant strip kernels/offset.h "arcs of a single point" 'define CAMBER_OFFSET_ARC_POINTS_MAX 64u' 'define CAMBER_OFFSET_ARC_POINTS_MAX 1u'

# ---- Join maths, which kernels and twin share: pixels tell ----

group=pixels
mutant strip kernels/join.h "turns to the other side" 'aside = dx * ey - dy * ex' 'aside = dy * ex - dx * ey'
mutant strip kernels/join.h "turns of half the angle" 'turn.c) * CAMBER_LARGEST_TURN' 'turn.c) * 0.5f * CAMBER_LARGEST_TURN'
mutant strip kernels/join.h "no join is tight" 'tight = row->reach_px * sine > ' 'tight = -row->reach_px * sine > '
mutant strip kernels/join.h "split miters cut like bevels" 'split_end = miter   ?' 'split_end = !miter ?'
mutant strip kernels/join.h "a miter past its limit" 'turn.c * row->miter_limit >= 1.0f' 'turn.c * row->miter_limit <= 1.0f'
mutant strip kernels/join.h "round joins past their limit" 'turn.c > row->round_cos' 'turn.c < row->round_cos'
mutant strip kernels/join.h "round and square caps swapped" 'cap == CAMBER_CAPS_ROUND ' 'cap == CAMBER_CAPS_SQUARE '
mutant fan kernels/join.h "fans of one triangle" 'x > turn_cos && y > 0.0f' 'x < turn_cos && y > 0.0f'

# ---- Networks: the twin tells of the cull stages, pixels and the window of what they share with it ----

group=networks
mutant strip kernels/cull_count.cl "chunks that are not counted" 'counts[item] = w.at' 'counts[item] = chunk % 7u == 5u ? 0u : w.at'
mutant strip kernels/cull_emit.cl "x in the place of y" '{x, y, importance, slot_x' '{y, x, importance, slot_x'
mutant strip kernels/cull_emit.cl "chunks that skip where there is something" 'bases[item + 1u] > bases[item]' \
    'bases[item + 1u] > bases[item] + 1u'
mutant strip kernels/cull.h "a side of the window" 'x > p->window_x1 + grown ? 2u' 'x > p->window_x1 + grown ? 1u'
mutant strip kernels/cull.h "the farther side of the window" 'return tx < ty ? tx : ty' 'return tx > ty ? tx : ty'
mutant strip kernels/cull.h "a corner of the window that is cut off" '> 1.0f)))' '> 1.5f)))'
mutant strip kernels/cull.h "important points that go" 'return w->importance[i] >= p->tolerance' \
    'return w->importance[i] > p->tolerance'
mutant strip kernels/cull.h "segments to points that are left out" 'if (!camber_matters(w, p, i))' \
    'if (!(w->importance[i] >= 0.0f))'
mutant strip kernels/cull.h "ends that are not pulled" 'if (out == 0u)' 'if (out < 16u)'
mutant strip kernels/cull.h "ends pulled past the window" 'if (mid_out & out) {' 'if (mid_out) {'
mutant strip kernels/cull.h "a seam that is an end" 'begins == has_next ? CAMBER_POINT_RING' 'begins != has_next ? CAMBER_POINT_RING'
mutant strip kernels/cull.h "the sentinel behind in the place of the one before" 'camber_walk_put_sentinel(w, p, 1u, a)' \
    'camber_walk_put_sentinel(w, p, 0u, a)'
mutant strip kernels/cull.h "a sentinel on the seam" 'other.point > w->first && camber_same_pixel(other, seam)' \
    'other.point > w->first && !camber_same_pixel(other, seam)'
mutant strip kernels/cull.h "pieces that do not begin" 'real | CAMBER_POINT_FIRST | CAMBER_POINT_CUT' 'real'
mutant strip kernels/cull.h "pieces that end where they began" 'camber_put_kept(w, p, piece->to, real | (is_seam' \
    'camber_put_kept(w, p, piece->from, real | (is_seam'
mutant strip kernels/cull.h "stretches that are not seen" 'stretch->x1 < p->seen_x0' 'stretch->x0 < p->seen_x0'
mutant strip kernels/cull.h "pixels turned the other way" 'p->down_x + p->at_x' '-p->down_x + p->at_x'

# ---- Shaders ----

group=pixels
mutant strip kernels/join.h "cuts at the tangent of another angle" 'return 2.0f * q / ' 'return q / '
mutant strip kernels/join.h "cuts on the wrong side" 'cut = -end * side' 'cut = end * side'
mutant strip kernels/join.h "butt ends without a pad" '? CAMBER_PAD_PX : CAMBER_NO_LIMIT_PX' '? 0.0f : CAMBER_NO_LIMIT_PX'
mutant kite kernels/join.h "kites cut on the outer side" 'CUT && is_inner)' 'CUT && !is_inner)'
mutant fan kernels/join.h "a fan that turns back" ': CAMBER_SIN(angle) * arc' ': -CAMBER_SIN(angle) * arc'
mutant strip shaders/stroke.vert "a segment from its end to its start" 'goes_out ? other.p - here.p' 'goes_out ? here.p - other.p'
mutant strip shaders/stroke.vert "breaks that are drawn" 'right = !right;' ''
mutant strip shaders/stroke.vert "a tight start placed by the end of no length" 'is_again ? i - 2' 'is_again ? i - 1'
mutant strip shaders/stroke.vert "no pad" 'half_width + CAMBER_PAD_PX' 'half_width'

# ---- The formulas of strokes, which shaders, kernels and twin share: pixels tell ----

mutant strip kernels/stroke_setup.inl "the slope of an edge" 'slope = safe * scale' 'slope = 0.8f * safe * scale'
mutant strip kernels/stroke_setup.inl "the corner of a pixel" 'bend * bend * e->curve' 'bend * e->curve'
reports=(--pictures "$tmp/pictures" --junit "$tmp/junit.xml")
mutant strip kernels/stroke.h "half the width" 'half_width - at->d, 1.0f) +' '0.9f * half_width - at->d, 1.0f) +'
reports=()
mutant strip kernels/stroke_ends.h "the sine of a turn" '2.0f * q * scale' 'q * scale'
mutant strip shaders/stroke.frag "the wrong side of a bisector" 'p.cb * at.past_b + p.sb * at.y' 'p.cb * at.past_b - p.sb * at.y'
mutant strip kernels/stroke_setup.inl "square caps of a whole width" 'CAMBER_ENDS_SQUARE ? half_width' \
    'CAMBER_ENDS_SQUARE ? 2.0f * half_width'
mutant strip kernels/stroke.h "bevels that reach too far" 'l->bevel ? half_width * c' 'l->bevel ? half_width'
mutant strip kernels/stroke_flat.h "a bend to the wrong side" 'at->y - bend' 'at->y + bend'
mutant strip kernels/stroke_setup.inl "caps of thin lines" '0.5f + 0.785398f * half_width + 1.2f' '0.5f + 1.2f'
mutant strip shaders/stroke.frag "united lines: no edge between whole and part" '* (area * (1.0 - area)), area, area)' \
    '* area, area, area)'
mutant strip kernels/stroke_flat.h "united lines: both sides face the same way" 'in_y = at->y * scale' \
    'in_y = CAMBER_FABS(at->y) * scale'
mutant strip shaders/stroke.frag "united lines: areas that are not summed" 'area * (1.0 - area)), area, area)' \
    'area * (1.0 - area)), 0.0, area)'
mutant strip kernels/union.h "united lines: edges that face alike are added up" 'cosine < 0.0f ? apart : more' \
    'cosine > 0.0f ? apart : more'
mutant strip kernels/union.h "united lines: every two edges face alike" 'weight = CAMBER_FABS(cosine)' 'weight = one'
mutant strip kernels/union.h "united lines: one over the other" 'weight = CAMBER_FABS(cosine)' 'weight = none'

# Areas, paints along lines, and bands beside them.
group='along lines: areas'
mutant strip kernels/area.h "areas: edges through a tile's left side" 't->turn = enters ? -e->down' 't->turn = enters ? 0.0f * e->down'
mutant strip kernels/area.h "areas: pixels that an edge enters" 'rise * inner * inner' '0.0f * rise * inner'
mutant strip kernels/area_inside.h "areas: holes that fill" 'sum < 0 ? -sum : sum' \
    'CAMBER_AREA_ONE + (sum < 0 ? -sum : sum)'
mutant strip kernels/area_inside.h "areas: overlaps that count twice" 'of.least < -1 || of.most > 1 || of.most - of.least > 1' \
    'of.least < -9'
mutant strip kernels/area.h "areas: level edges that mark no cell" 'else if (camber_integer_of(&t->flat, k))' 'else if (0)'
mutant strip kernels/area.h "areas: edges inside a pixel that end with their cells" 'CAMBER_ADD_TO(on + first + i, height)' 'CAMBER_ADD_TO(on + first + i, 0u)'
mutant strip kernels/area.h "areas: pixels as high as their tops" 'CAMBER_LANES * v + CAMBER_CELL_PX)' 'CAMBER_LANES * v)'
mutant strip kernels/rasterize.cl "areas: bunches of other areas" 'CAMBER_LOAD(v, brushes) == brush' 'CAMBER_LOAD(v, brushes) != brush'
group='along lines: glyphs'
mutant strip kernels/area.h "glyphs: counters that wind like the glyph" 'e->down = down ? CAMBER_REAL(1.0f) : CAMBER_REAL(-1.0f)' \
    'e->down = down ? CAMBER_REAL(1.0f) : CAMBER_REAL(1.0f)'
drawer=(--draw cl) # GL draws halos by its shaders
mutant strip kernels/tile_state.h "glyphs: halos shine through them" 'camber_let_through(through * (1.0f - area))' 'through'
drawer=()
group='along lines'
mutant strip kernels/features.h "gaps that are not cut out" 'area > gap ? area - gap' 'area > gap ? area'
mutant strip kernels/features.h "a fade half as wide" '(blur + 1.0f)' '(0.5f * blur + 1.0f)'
mutant strip kernels/features.h "a smooth fade that is even" 'e->blur < 0.0f ?' 'e->blur < -1e9f ?'
mutant strip kernels/features.h "dashes that do not end" 'camber_cut_along(p, at, place.at + ends.past - to)' '0.0f'
mutant strip kernels/features.h "the nearest round dash" '(least < to ? least : to)' 'least'
mutant strip kernels/features.h "the period of dashes" 'before = e->period * ' 'before = 1.1f * e->period * '
mutant strip kernels/features.h "what is trimmed and what is not" 'at->along - e->trim_from)' 'e->trim_from - at->along)'
mutant strip kernels/features.h "a place along the line" '(least < p->length ? least : most)' '0.5f * (least < p->length ? least : most)'
group='ramp'
mutant strip kernels/features.h "steps at the pixel before" 'from = along - extent' 'from = along + extent'
mutant strip kernels/features.h "colours at the ends of pieces" \
    'CAMBER_STOP_COLOR(e, i, k) * (1.0f - part) + CAMBER_STOP_COLOR(e, next, k) * part) * share' \
    'CAMBER_STOP_COLOR(e, i, k)) * share'
group=image
mutant strip kernels/images.h "images that begin anew with each segment" 'm->phase + x * m->rate' 'x * m->rate'
mutant strip kernels/images.h "images upside down" '0.5f - (at->y > 0.0f ? off : side)' '0.5f + (at->y > 0.0f ? off : side)'
mutant strip kernels/images.h "images that lie elsewhere" 'x = at->x - m->left' 'x = at->x + m->left'
group='at 40 degrees'
mutant strip kernels/pitch.h "a pitch: a plane that is not turned" 'y * e.cosine * by_depth' 'y * by_depth'
mutant strip kernels/pitch_segment.h "a pitch: edges of areas that end where they begin" 'is_whole ? s->by' 'is_whole ? s->ay'
mutant strip kernels/stroke_pitched.h "a pitch: lines as wide far away as near" \
    'CAMBER_REF(x), CAMBER_REF(y)) * at->by_depth' 'CAMBER_REF(x), CAMBER_REF(y))'
group='translucent ramp'
mutant strip shaders/stroke.frag "translucent ramps that are opaque" 'o_alpha = vec4(o_color.a' 'o_alpha = vec4(area'
group='along lines'
mutant strip shaders/flatten.frag "alphas that are left beside" 'vec4(layer.rgb, texelFetch' 'vec4(layer.rgb, layer.a) + 0.0 * vec4(texelFetch'
mutant strip kernels/arc_length_scan.cl "lengths that are not summed" 'FIRST ? 0 : sum + ' 'FIRST ? 0 : '
mutant strip kernels/emit.cl "arc lengths of the neighbour" 'as_uint(arc_lengths[2 * i])' 'as_uint(arc_lengths[2 * i + 2])'

# ---- Kernels that draw: the twin tells. Where it tells without --full, it takes half as long ----

drawer=(--draw cl)
level=()
group=pictures
mutant strip kernels/layout.h "a pad of another width on the device" '#define CAMBER_PAD_PX 0.75f' \
    '#define CAMBER_PAD_PX 0.7f'
mutant strip kernels/setup.cl "a segment from its end to its end" 'take_words(from.x, at - 1, r)' 'take_words(from.x, at, r)'
mutant strip kernels/setup.cl "a direction that is not that of the segment before" 'take_words(from.x, first - 1, r)' \
    'take_words(from.x, first, r)'
mutant strip kernels/setup.cl "the table of another pass" 'take_rows(rows, r->first_row,' 'take_rows(rows, 0u * r->first_row,'
mutant strip kernels/setup.cl "lines that go on to the next" '((e->b.info & CAMBER_POINT_FIRST) == 0u)' \
    '((e->b.info & CAMBER_POINT_FIRST) != 99u)'
mutant strip kernels/setup.cl "a pitch: a cut in the place of the other" 'p->cut_b.owner, p->cut_a.x' \
    'p->cut_a.owner, p->cut_a.x'
mutant strip kernels/setup.cl "areas: all by the first fill" 'brushes += next;' 'brushes += 0u * next;'
mutant strip kernels/setup.cl "areas: fills that change too early" 'numbers) >= own[next] - first' \
    'numbers) < own[next] - first'
mutant strip kernels/bins.cl "a tile too few in a span" 'x <= span >> 8' 'x < span >> 8'
mutant strip kernels/bins.cl "boxes of two tiles without the second" 'count += b.has_last[k]' 'count += 0u * b.has_last[k]'
mutant strip kernels/bin_scan.cl "sums with what comes behind" 'vstore16(sum, at, of_chunk)' 'vstore16(sum + here, at, of_chunk)'
mutant strip kernels/bins.cl "lists that are turned over" 'to->lists[to->starts[list] + to->own[list]++]' \
    'to->lists[to->starts[list + 1] - 1u - to->own[list]++]'
mutant strip kernels/rasterize_sixteen.cl "cells of segments that wait in vain" 'k < count; k++) {
        const ulong cells = sets->partial[k] & ~shut, nears' 'k + 1u < count; k++) {
        const ulong cells = sets->partial[k] & ~shut, nears'
mutant strip kernels/rasterize_sixteen.cl "cells filled by segments that only touch them" 'drawn |= sets->full[k]' \
    'drawn |= sets->partial[k]'
mutant strip kernels/rasterize_sixteen.cl "caps at both ends" '(p->goes_on_b ? none : at_b)' '(p->goes_on_a ? none : at_b)'
mutant strip kernels/rasterize_sixteen.cl "flat joins taken for caps" 'joined_a | joined_b' 'joined_a'
mutant strip kernels/rasterize_sixteen.cl "caps at the other end" 'p->flat_b - at->past_b' 'p->flat_a - at->past_b'
level=(--full) # 1, 8 and 16 lanes
mutant strip kernels/rasterize.cl "rows of cells that lie abreast, from the top" 'v * (CAMBER_LANES / CAMBER_CELL_PX)' '0 * v'
mutant strip kernels/rasterize_gpu.cl "GPUs: a tile's cells that change places" 'cell % CAMBER_TILE_CELLS, (int)item' \
    'cell / CAMBER_TILE_CELLS, (int)item'
mutant strip kernels/rasterize_gpu.cl "GPUs: batches whose changes the next forgets" 'add_changes(&batch, count, &changes)' \
    'add_changes(&batch, 0u, &changes)'
mutant strip kernels/area_gpu.cl "GPUs: areas as if no edge were left of a cell" 'sum += s->changes' 'sum += 0u * s->changes'
mutant strip kernels/bins_gpu.cl "GPUs: pairs that all come first in their lists" 'before += i < pair ? same : 0u' \
    'before += i < pair ? 0u : 0u'
level=()
mutant strip kernels/draw_cells.h "one pixel after the other: cells that lie elsewhere" 'where.left + 0.5f + (float)' \
    'where.left + (float)'
mutant strip kernels/rasterize.cl "lists that end too soon" 'k-- > starts[tile];' 'k-- > starts[tile] + 1u;'

# A picture in slices alone shows these.
mutant strip kernels/spill_cell.cl "slices: sums of a union that are not whole" 'c->sums[i][0], s.sums, 3, share);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_PICTURE))
        spill' 'c->sums[i][0], s.sums, 2, share);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_PICTURE))
        spill'
mutant strip kernels/spill_cell.cl "slices: a layer without alpha" 'restore_planes(planes, c->level[CAMBER_LAYER][i][0], s.layer, 4' \
    'restore_planes(planes, c->level[CAMBER_LAYER][i][0], s.layer, 3'
mutant strip kernels/spill.cl "slices: areas without what lies left of them" 'c->winding = (int)open' 'c->winding = 0 * (int)open'

mutant strip kernels/wind.cl "areas: all rows by the top of the first" 'of.top + (float)(row * CAMBER_TILE_PX)' 'of.top'
mutant strip kernels/rasterize.cl "areas: tiles that forget the corner" 'c.winding = camber_take_winding' 'c.winding = 0 * camber_take_winding'

# ---- Coverage, tiles and cells, which these kernels and their twin share: pixels tell ----

group='along lines: areas'
mutant strip kernels/segment.h "areas: edges that no row of tiles knows" '? 0u : CAMBER_BOX_FIRST_Y(box) + 1u' \
    '? 0u : CAMBER_BOX_LAST_Y(box) + 1u'
group=pixels
mutant strip kernels/tile_state.h "cells that are done too early" 'camber_most_of(most) < CAMBER_NOTHING_PX' \
    'camber_most_of(most) < 0.5f'
mutant strip kernels/tile_state.h "what lies below shines through" 'camber_let_through(through * (1.0f - area))' 'through'
mutant strip kernels/tile_state.h "united lines: areas that are not summed" 'c->sums[i][0][v] += ' 'c->sums[i][0][v] = '
mutant strip kernels/tile_state.h "cells that keep what they had" 'cells & ~c->brushed; left' 'cells & c->brushed; left'
mutant strip kernels/cells.h "cells that are whole too soon" 'h - p->side.extent - reach : always' 'h - p->side.extent : always'
mutant strip kernels/cells.h "cells that a cap reaches" 'CAMBER_LESS(p->flat_b, h) + CAMBER_PAD_PX + reach_b' \
    '-CAMBER_PAD_PX - reach_b'
mutant strip kernels/cells.h "cells beside the line" 'h + p->side.extent + reach + bend' '0.5f * h'
mutant strip kernels/stroke_setup.inl "the slope of an edge" 'slope = safe * scale' 'slope = 0.8f * safe * scale'
level=(--full) # every join and cap
mutant strip kernels/stroke.h "half the width, of lines wider than a pixel" 'p->half_width - at->d, 1.0f)' \
    '0.9f * p->half_width - at->d, 1.0f)'
mutant strip kernels/stroke_flat.h "a bend to the wrong side" 'at->y - bend' 'at->y + bend'
mutant strip kernels/stroke_flat.h "a cut on the wrong side" 'CAMBER_BOTH(at->fb >= CAMBER_TIE(at)' \
    'CAMBER_BOTH(at->fb < CAMBER_TIE(at)'
mutant strip kernels/stroke_caps.inl "flat joins: bodies that end on the wrong side" 'f.behind ? body : before' \
    'f.behind ? before : body'
mutant strip kernels/stroke_setup.inl "caps of thin lines" '0.5f + 0.785398f * half_width + 1.2f' '0.5f + 1.2f'
mutant strip kernels/union.h "united lines: edges that face alike are added up" 'cosine < 0.0f ? apart : more' \
    'cosine > 0.0f ? apart : more'
mutant strip kernels/segment.h "boxes without joins" 'CAMBER_MORE(reach_a, reach_b)' '0.5f * CAMBER_LESS(reach_a, reach_b)'
level=()
group='at 40 degrees'
mutant strip kernels/edge.h "a pitch: cells at a side that are left out" 'in_left > -past_left - left' 'in_left > left'
drawer=()

case $verb in
--texts) echo "$caught rows stand, $failures failures" ;;
*) echo "$caught caught, $failures failures" ;;
esac
[ "$failures" = 0 ]
