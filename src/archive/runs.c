/* Makes one ascending list of runs from the tiles that were added and from the tiles of other archives.
 *
 * Input: both lists, in the order in which they arrived. Output: disjoint runs, in which neighbouring runs have
 * different contents, or the first tile number for which two archives have different contents. Runs are never expanded,
 * so that a sea of a million tiles stays one item. */
#include "archive/writer.h"

#include <stdlib.h>

static int compare_runs(const void *left, const void *right) {
    const camber_archive_run *a = left, *b = right;
    if (a->number != b->number)
        return a->number < b->number ? -1 : 1;
    return a->order < b->order ? -1 : a->order > b->order;
}

static void sort(camber_archive_runs *runs) {
    for (size_t i = 1; i < runs->count; i++)
        if (compare_runs(&runs->items[i - 1], &runs->items[i]) > 0) {
            qsort(runs->items, runs->count, sizeof *runs->items, compare_runs);
            return;
        }
}

/* Keeps only the last tile with each number. Added tiles are runs of length 1. */
static void keep_last(camber_archive_runs *runs) {
    size_t kept = 0;
    for (size_t i = 0; i < runs->count; i++) {
        const bool again = kept && runs->items[kept - 1].number == runs->items[i].number;
        kept += !again;
        runs->items[kept - 1] = runs->items[i];
    }
    runs->count = kept;
}

/* Shortens overlapping runs with equal contents until they are disjoint. A run is only compared with the last one,
 * because all earlier runs that reach beyond its start have the same content. */
static void keep_disjoint(camber_archive_runs *runs, camber_archive_conflict *conflict) {
    size_t kept = 0;
    for (size_t i = 0; i < runs->count && !conflict->found; i++) {
        camber_archive_run run = runs->items[i];
        const camber_archive_run *last = kept ? &runs->items[kept - 1] : NULL;
        const uint64_t end = last ? last->number + last->length : 0;
        if (last && run.number < end) {
            if (run.content != last->content) {
                *conflict = (camber_archive_conflict){true, run.number, {last->order, run.order}};
                return;
            }
            const uint64_t range_end = run.number + run.length;
            if (range_end <= end)
                continue;
            run.number = end;
            run.length = range_end - end;
        }
        runs->items[kept++] = run;
    }
    runs->count = kept;
}

/* Appends a run, or lengthens the last run if this one continues it with the same content. */
static bool append(camber_context *context, camber_archive_runs *made, const camber_archive_run *run) {
    camber_archive_run *last = made->count ? &made->items[made->count - 1] : NULL;
    if (run->length == 0 || run->content == CAMBER_NO_CONTENT)
        return true;
    if (last && last->content == run->content && last->number + last->length == run->number) {
        last->length += run->length;
        return true;
    }
    if (!camber_grow(context, &made->items, &made->capacity, made->count + 1, sizeof *made->items))
        return false;
    made->items[made->count++] = *run;
    return true;
}

camber_status camber_archive_resolve(camber_context *context, camber_archive_runs *added, camber_archive_runs *taken,
                                     camber_archive_runs *made, camber_archive_conflict *conflict) {
    sort(added);
    keep_last(added);
    sort(taken);
    keep_disjoint(taken, conflict);
    size_t a = 0, t = 0;
    while (!conflict->found && (a < added->count || t < taken->count)) {
        camber_archive_run *from = t < taken->count ? &taken->items[t] : NULL;
        const camber_archive_run *over = a < added->count ? &added->items[a] : NULL;
        if (over && (!from || over->number <= from->number)) {
            if (from && over->number == from->number) {
                made->removed += over->content == CAMBER_NO_CONTENT;
                from->number++;
                from->length--;
                t += from->length == 0;
            }
            if (!append(context, made, over))
                return CAMBER_ERROR_MEMORY;
            a++;
            continue;
        }
        if (!from)
            break;
        camber_archive_run piece = *from;
        if (over && over->number - from->number < from->length)
            piece.length = over->number - from->number;
        if (!append(context, made, &piece))
            return CAMBER_ERROR_MEMORY;
        from->number += piece.length;
        from->length -= piece.length;
        t += from->length == 0;
    }
    return CAMBER_OK;
}
