/* Threads with numbers, also if the system has fewer than are wanted: pthread_create is wrapped, and refuses from some
 * call on. */
#define _GNU_SOURCE /* sched_setaffinity */

#include "core.h"

#include "base/threads.h"

#include <errno.h>
#include <sched.h>
#include <stdatomic.h>

static int allowed;

int __real_pthread_create(pthread_t *id, const pthread_attr_t *how, void *(*work)(void *), void *user);
int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *how, void *(*work)(void *), void *user);
int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *how, void *(*work)(void *), void *user) {
    return allowed-- > 0 ? __real_pthread_create(id, how, work, user) : EAGAIN;
}

typedef struct calls {
    atomic_int of[CAMBER_MOST_THREADS + 8];
    pthread_t by[CAMBER_MOST_THREADS + 8];
    pthread_mutex_t gate; /* held until all may end */
    bool waits;
} calls;

static void work(void *user, size_t number) {
    calls *c = user;
    atomic_fetch_add(&c->of[number], 1);
    c->by[number] = pthread_self();
    if (c->waits) {
        pthread_mutex_lock(&c->gate);
        pthread_mutex_unlock(&c->gate);
    }
}

static void run(size_t count, int threads) {
    static calls c;
    c = (calls){.waits = false};
    allowed = threads;
    camber_threads_run(count, work, &c);
    for (size_t i = 0; i < sizeof c.of / sizeof *c.of; i++)
        assert_int_equal(c.of[i], i < count);
    for (size_t i = 0; i < count; i++) /* number 0, and those without a thread of their own */
        assert_int_equal(pthread_equal(c.by[i], pthread_self()) != 0, i == 0 || i > (size_t)threads);
}

static void test_run(void **state) {
    (void)state;
    run(1, 8);
    run(5, 8);
    run(5, 2);
    run(5, 0);
    run(CAMBER_MOST_THREADS, 10);
    run(CAMBER_MOST_THREADS + 8, 3);
}

static void test_start(void **state) {
    (void)state;
    static calls c;
    camber_threads threads;
    c = (calls){.waits = true};
    allowed = 3;
    pthread_mutex_init(&c.gate, NULL);
    pthread_mutex_lock(&c.gate);
    camber_threads_start(&threads, 6, work, &c);
    assert_int_equal(threads.count, 3);
    while (c.of[0] + c.of[1] + c.of[2] < 3) /* all of them run at the same time */
        continue;
    pthread_mutex_unlock(&c.gate);
    camber_threads_join(&threads);
    assert_int_equal(threads.count, 0);
    assert_int_equal(c.of[3], 0);
    camber_threads_join(&threads);
    pthread_mutex_destroy(&c.gate);
}

static void test_count(void **state) {
    (void)state;
    assert_in_range(camber_threads_count(0), 1, CAMBER_MOST_THREADS);
    assert_int_equal(camber_threads_count(7), 7);
    assert_int_equal(camber_threads_count(1000000), CAMBER_MOST_THREADS);
}

/* Work for one core gets one thread, however many cores the machine has. */
static void test_affinity(void **state) {
    (void)state;
    cpu_set_t before, one;
    if (sched_getaffinity(0, sizeof before, &before) != 0)
        skip();
    assert_int_equal(camber_cores_count(), CPU_COUNT(&before));
    size_t core = 0;
    while (!CPU_ISSET(core, &before))
        core++;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    assert_int_equal(camber_cores_count(), 1);
    assert_int_equal(camber_threads_count(0), 1);
    assert_int_equal(sched_setaffinity(0, sizeof before, &before), 0);
}

/* The quota of a container's control group, or of one above it, limits threads as affinity does. */
static void test_quota(void **state) {
    (void)state;
    char root[64];
    folder_make(root);
    assert_true(camber_cores_paid(root) == SIZE_MAX); /* no control group */
    folder_write(root, "proc/self/cgroup", "1:name=systemd:/other\n0::/app/worker\n");
    assert_true(camber_cores_paid(root) == SIZE_MAX); /* no limit */
    folder_write(root, "sys/fs/cgroup/app/worker/cpu.max", "max 100000\n");
    assert_true(camber_cores_paid(root) == SIZE_MAX);
    folder_write(root, "sys/fs/cgroup/app/worker/cpu.max", "350000 100000\n");
    assert_int_equal(camber_cores_paid(root), 4);
    folder_write(root, "sys/fs/cgroup/app/cpu.max", "50000 100000\n");
    assert_int_equal(camber_cores_paid(root), 1);
    static const char *const others[] = {"no quota\n", "",        "0 100000\n",
                                         "50000 0\n",  "50000\n", "99999999999999999999999999 1\n"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        folder_write(root, "sys/fs/cgroup/app/cpu.max", others[i]);
        assert_int_equal(camber_cores_paid(root), 4);
    }
    folder_write(root, "proc/self/cgroup", "0::/\n"); /* as inside of a container */
    folder_write(root, "sys/fs/cgroup/cpu.max", "200000 100000\n");
    assert_int_equal(camber_cores_paid(root), 2);
    folder_remove(root);
}

/* The same of version 1, where each controller has groups of its own. */
static void test_quota_of_version_1(void **state) {
    (void)state;
    static const struct {
        const char *groups, *quota;
        size_t paid;
    } cases[] = {{"5:cpuset:/\n4:cpuacct,cpu:/app/worker\n0::/\n", "150000\n", 2},
                 {"1:cpu:/app/worker\n", "-1\n", SIZE_MAX},
                 {"1:cpu:/app/worker\n", "0\n", SIZE_MAX},
                 {"1:cpu:/app/worker\n", "no number\n", SIZE_MAX},
                 {"1:cpu:/app/other\n", "150000\n", SIZE_MAX},
                 {"1:cpuset,cpuacct:/app/worker\n2:name=cpu:/app/worker\n", "150000\n", SIZE_MAX},
                 {"cpu:/app/worker\n1:cpu\n\n", "150000\n", SIZE_MAX}};
    char root[64];
    folder_make(root);
    folder_write(root, "sys/fs/cgroup/cpu/app/worker/cpu.cfs_period_us", "100000\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        folder_write(root, "proc/self/cgroup", cases[i].groups);
        folder_write(root, "sys/fs/cgroup/cpu/app/worker/cpu.cfs_quota_us", cases[i].quota);
        assert_int_equal(camber_cores_paid(root), cases[i].paid);
    }
    /* A container sees its group as the first, but the path of the host. */
    folder_write(root, "proc/self/cgroup", "3:cpu,cpuacct:/docker/0123\n");
    folder_write(root, "sys/fs/cgroup/cpu/cpu.cfs_quota_us", "250000\n");
    folder_write(root, "sys/fs/cgroup/cpu/cpu.cfs_period_us", "50000\n");
    assert_int_equal(camber_cores_paid(root), 5);
    folder_remove(root);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_run),   cmocka_unit_test(test_start),
                                       cmocka_unit_test(test_count), cmocka_unit_test(test_affinity),
                                       cmocka_unit_test(test_quota), cmocka_unit_test(test_quota_of_version_1)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
