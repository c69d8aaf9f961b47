/* student.c - lists the eleven functions of the student's file, HOMEWORK.
 * FUNCTIONS is F(name) for each function of tasks.txt, in order (check.sh). */
#define main student_main
int main(int argc, char **argv);
#include HOMEWORK
#undef main

typedef void Function(void);
#define F(name) (Function *)name,
Function *const student[] = {FUNCTIONS};
