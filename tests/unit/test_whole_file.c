/* Files that appear whole or not at all, also on a file system without hard links: link is wrapped, and refuses at
 * will. */
#define _XOPEN_SOURCE 700

#include "base/whole_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static bool has_links;

int __real_link(const char *from, const char *to);
int __wrap_link(const char *from, const char *to);
int __wrap_link(const char *from, const char *to) {
    if (has_links)
        return __real_link(from, to);
    errno = EPERM;
    return -1;
}

static void write_text(const char *path, const char *text, int result) {
    const camber_file_part parts[] = {{text, 2}, {text + 2, strlen(text) - 2}};
    assert_int_equal(camber_whole_file_write(path, strlen(path), 0640, parts, 2), result);
}

static void assert_text(const char *path, const char *wanted) {
    char text[64] = {0};
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    (void)fread(text, 1, sizeof text - 1, file);
    fclose(file);
    assert_string_equal(text, wanted);
}

/* How many files there are in the working folder. */
static int count_files(void) {
    int count = 0;
    DIR *folder = opendir(".");
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;)
        count += entry->d_name[0] != '.';
    closedir(folder);
    return count;
}

static void test_write(void **state) {
    (void)state;
    struct stat about;
    const mode_t mask = umask(0077);
    write_text("plain", "first", 0);
    umask(mask);
    assert_int_equal(stat("plain", &about), 0);
    assert_int_equal(about.st_mode & 0777, 0640);
    write_text("plain", "second", 0);
    assert_text("plain", "second");
    const camber_file_part part = {"deep", 4};
    assert_int_equal(camber_whole_file_write("a/b/c", 0, 0644, &part, 1), 0);
    assert_text("a/b/c", "deep");
    assert_int_equal(camber_whole_file_write("x/b/c", 2, 0644, &part, 1), ENOENT); /* x has to be there */
    assert_int_equal(camber_whole_file_write("plain/c", 0, 0644, &part, 1), ENOTDIR);
    assert_int_equal(camber_whole_file_write("a", 1, 0644, &part, 1), EISDIR);
    assert_int_equal(count_files(), 2); /* plain and a: nothing is left beside them */
}

/* Another file has the name, or comes to have it while this one is written. */
static void check_taken(void) {
    camber_whole_file whole;
    unlink("plain");
    assert_int_equal(camber_whole_file_begin(&whole, "plain", 0644), 0);
    assert_int_equal(camber_file_write(whole.file, "mine", 4, 0), 0);
    assert_int_equal(camber_file_sync(whole.file), 0);
    write_text("plain", "theirs", 0);
    assert_int_equal(camber_whole_file_end(&whole, 0, false), EEXIST);
    assert_text("plain", "theirs");
    assert_int_equal(camber_whole_file_begin(&whole, "plain", 0644), 0);
    assert_int_equal(camber_file_write(whole.file, "..ne", 4, 0), 0);
    assert_int_equal(camber_file_write(whole.file, "mi", 2, 0), 0);
    assert_int_equal(camber_whole_file_end(&whole, 0, true), 0);
    assert_text("plain", "mine");
    assert_int_equal(camber_whole_file_begin(&whole, "other", 0644), 0);
    assert_int_equal(camber_whole_file_end(&whole, 0, false), 0);
    assert_int_equal(unlink("other"), 0);
    assert_int_equal(camber_whole_file_begin(&whole, "other", 0644), 0);
    assert_int_equal(camber_whole_file_end(&whole, ENOSPC, true), ENOSPC);
    assert_int_equal(access("other", F_OK), -1);
    assert_int_equal(symlink("nothing", "other"), 0); /* a link to no file is a name that is taken */
    assert_int_equal(camber_whole_file_begin(&whole, "other", 0644), 0);
    assert_int_equal(camber_whole_file_end(&whole, 0, false), EEXIST);
    assert_int_equal(unlink("other"), 0);
    assert_int_equal(count_files(), 2);
}

static void test_taken(void **state) {
    (void)state;
    check_taken();
    has_links = false;
    check_taken();
    has_links = true;
}

static void test_folders(void **state) {
    (void)state;
    assert_int_equal(mkdir("made", 0755), 0);
    assert_int_equal(camber_file_name("made", "a", false), EEXIST);
    assert_int_equal(camber_file_name("made", "new", false), 0);
    assert_int_equal(rmdir("new"), 0);
}

static void test_cures(void **state) {
    (void)state;
    assert_string_equal(camber_file_cure(EACCES, "other"), "other");
    assert_string_equal(camber_file_cure(ENOSPC, "other"), camber_file_cure(EIO, "other"));
    assert_true(camber_file_fails_anyway(ENOSPC) && !camber_file_fails_anyway(EACCES));
}

int main(void) {
    char folder[] = "/tmp/camber-test-XXXXXX";
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_write), cmocka_unit_test(test_taken),
                                       cmocka_unit_test(test_folders), cmocka_unit_test(test_cures)};
    has_links = true;
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    const bool removed = unlink("a/b/c") == 0 && rmdir("a/b") == 0 && rmdir("a") == 0 && unlink("plain") == 0 &&
                         chdir("/") == 0 && rmdir(folder) == 0;
    return failed || !removed;
}
