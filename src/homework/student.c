/* student.c - lists the eleven functions of the student's file, HOMEWORK.
 * check.sh defines TASK_FUNCTIONS: F(name) for each function of tasks.txt. */
#define main student_main
int main(int argc, char **argv);
#include HOMEWORK
#undef main

typedef void TaskFunction(void);
#define F(name) (TaskFunction *)name,
TaskFunction *const student[] = {TASK_FUNCTIONS};
