/* Shell completion of the command line. */
#ifndef CAMBER_CLI_COMPLETION_H
#define CAMBER_CLI_COMPLETION_H

#include <stdio.h>

/* In the order of the words of --completion. */
typedef enum camber_shell {
    CAMBER_SHELL_BASH = 0,
    CAMBER_SHELL_ZSH,
    CAMBER_SHELL_FISH,
} camber_shell;

/* Prints a script that completes verbs, options, their values and files. Users source it, or the shell finds it in its
 * folder of completions, where installing camber puts it. */
void camber_completion_print(camber_shell shell, FILE *file);

#endif
