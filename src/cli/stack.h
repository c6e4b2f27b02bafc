/* A stack that drivers can work on, whatever ulimit -s says. */
#ifndef CAMBER_CLI_STACK_H
#define CAMBER_CLI_STACK_H

/* Calls work(user) and returns what it returns: on a thread where this one's stack is too small. What starts further
 * threads gives them no smaller ones. Before other threads start. */
int camber_stack_run(int (*work)(void *user), void *user);

#endif
