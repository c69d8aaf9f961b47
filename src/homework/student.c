/* student.c - lists the eleven functions of the student's file, HOMEWORK, in the
 * order of tasks.txt.
 */
#define main student_main
int main(int argc, char **argv);
#include HOMEWORK
#undef main

typedef void Function(void);
Function *const student[] = {
    (Function *)inertia_val,    (Function *)inertia_grad,
    (Function *)inertia_hess,   (Function *)make_psd,
    (Function *)spring_val,     (Function *)spring_grad,
    (Function *)spring_hess,    (Function *)line_search,
    (Function *)residual,       (Function *)step_forward,
    (Function *)explicit_euler,
};
