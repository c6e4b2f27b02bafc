/* Runs info --warm: compiles and saves every kernel in advance. PoCL compiles one kernel at a time in a process, so
 * several processes compile a share of the kernels each. If one of them fails, this process compiles its share: it goes
 * through all kernels at the end, and prints the result. */
#include "cli/verbs.h"

#include "base/threads.h"

#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

/* Each process takes a quarter of a gigabyte. */
enum { PROCESSES_MAX = 4 };

static unsigned count_processes(const camber_options *options) {
    const size_t wanted = camber_threads_count(options->threads);
    return wanted < PROCESSES_MAX ? (unsigned)wanted : PROCESSES_MAX;
}

static camber_status warm_share(camber_session *session, unsigned share, unsigned shares, camber_warm_result *result) {
    const camber_status status = camber_session_open(session, CAMBER_NEEDS_DEVICE);
    return status == CAMBER_OK ? camber_device_warm(session->device, share, shares, result) : status;
}

static pid_t start_share(camber_session *session, unsigned share, unsigned shares) {
    camber_warm_result result;
    const pid_t process = fork();
    if (process != 0)
        return process;
    pthread_sigmask(SIG_SETMASK, &session->guard->before, NULL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    _exit(warm_share(session, share, shares, &result) == CAMBER_OK ? 0 : 1);
}

/* Must run before this process opens a device, because a forked process would not have the threads of its driver. */
static void warm_side_by_side(camber_session *session) {
    pid_t processes[PROCESSES_MAX];
    const unsigned shares = count_processes(session->options);
    for (unsigned i = 0; i < shares; i++)
        processes[i] = shares > 1 ? start_share(session, i, shares) : -1;
    for (unsigned i = 0; i < shares; i++) {
        int how;
        camber_report_step(session->report, "compiling", "processes", i, shares);
        if (processes[i] > 0)
            waitpid(processes[i], &how, 0);
    }
    camber_report_erase_bar(session->report);
}

static json_t *describe(camber_session *session, const camber_warm_result *result, double ms) {
    json_t *object = json_pack("{s:s, s:o, s:o, s:o, s:o}", "camber", camber_version(), "folder",
                               result->folder[0] ? camber_json_text(result->folder) : json_null(), "programs",
                               camber_json_count(result->programs), "compiled", camber_json_count(result->built), "ms",
                               camber_json_ms(ms));
    if (object)
        camber_session_describe(session, object);
    return object;
}

int camber_warm(camber_session *session) {
    camber_warm_result result;
    const double begin_ms = camber_now_ms();
    warm_side_by_side(session);
    const camber_status status = warm_share(session, 0, 1, &result);
    if (status != CAMBER_OK)
        return camber_report_status(session->report, status);
    const bool is_fixed = camber_device_get_info(session->device).fixed_kernels;
    if (!is_fixed && !result.folder[0])
        return camber_report_fail(
            session->report, CAMBER_EXIT_CREATE,
            "kernels: there is no writable folder to keep them in; set XDG_CACHE_HOME or CAMBER_KERNELS to one");
    if (result.kept < result.programs)
        return camber_report_fail(session->report, CAMBER_EXIT_IO,
                                  "%s: %zu of %zu programs could not be saved; free some space", result.folder,
                                  result.programs - result.kept, result.programs);
    const double ms = camber_now_ms() - begin_ms;
    if (session->options->json)
        return camber_report_json(session->report, describe(session, &result, ms));
    printf("kernels   %zu programs for %s, ready in %s\n          %s\n", result.programs,
           camber_device_get_info(session->device).name, camber_figure_time(ms).text,
           is_fixed ? "part of the library" : result.folder);
    const int printed = camber_report_flush(session->report);
    if (printed == CAMBER_EXIT_DONE)
        camber_report_done(session->report, "info", 0, camber_session_elapsed_ms(session), "%zu programs ready",
                           result.programs);
    return printed;
}
