/* Writes JSON pointers for messages: the position in the document, shortened so that the cause and the advice stay
 * visible. */
#include "style/compiler.h"

#include <stdio.h>

enum { HEAD = 120, TAIL = 60 };

typedef struct text {
    char head[HEAD];
    char tail[TAIL]; /* a ring buffer of the last bytes */
    size_t length;   /* bytes written so far */
} text;

static void put_byte(text *t, char c) {
    if (t->length < HEAD)
        t->head[t->length] = c;
    t->tail[t->length % TAIL] = c;
    t->length++;
}

static void put_step(text *t, const char *step) {
    put_byte(t, '/');
    for (; *step; step++) {
        if (*step == '~' || *step == '/') {
            put_byte(t, '~');
            put_byte(t, *step == '~' ? '0' : '1');
        } else {
            put_byte(t, *step);
        }
    }
}

static bool is_continued(char c) {
    return ((unsigned char)c & 0xc0) == 0x80;
}

/* Finds where to cut the head: after a step, or after a character of a long step. */
static size_t cut_head(const char head[HEAD]) {
    for (size_t end = HEAD; end > HEAD / 2; end--)
        if (head[end - 1] == '/')
            return end;
    size_t end = HEAD - 1;
    while (end > 0 && is_continued(head[end]))
        end--;
    return end;
}

static size_t cut_tail(const char tail[TAIL]) {
    for (size_t begin = 0; begin < TAIL / 2; begin++)
        if (tail[begin] == '/')
            return begin;
    size_t begin = 0;
    while (begin < TAIL && is_continued(tail[begin]))
        begin++;
    return begin;
}

void camber_compiler_write_pointer(const camber_compiler *c, char pointer[CAMBER_POINTER_SIZE]) {
    text t = {.length = 0};
    for (size_t i = 0; i < c->path_length && i < CAMBER_PATH_DEPTH; i++) {
        char number[24];
        snprintf(number, sizeof number, "%zu", c->path[i].index);
        put_step(&t, c->path[i].key ? c->path[i].key : number);
    }
    if (t.length <= HEAD) {
        memcpy(pointer, t.head, t.length);
        pointer[t.length] = 0;
        return;
    }
    char tail[TAIL];
    for (size_t i = 0; i < TAIL; i++)
        tail[i] = t.tail[(t.length + i) % TAIL];
    const bool is_whole = t.length <= HEAD + TAIL;
    const size_t head = is_whole ? HEAD : cut_head(t.head);
    const size_t begin = is_whole ? HEAD + TAIL - t.length : cut_tail(tail);
    snprintf(pointer, CAMBER_POINTER_SIZE, "%.*s%s%.*s", (int)head, t.head, is_whole ? "" : "...", (int)(TAIL - begin),
             tail + begin);
}
