/* Gives drivers a stack that is large enough, whatever ulimit -s says. */
#ifndef CAMBER_CLI_STACK_H
#define CAMBER_CLI_STACK_H

/* Calls work(user) and returns its result; on a new thread if this one's stack is too small. Threads that start later
 * get large stacks, too. Call it before other threads start. */
int camber_stack_run(int (*work)(void *user), void *user);

#endif
