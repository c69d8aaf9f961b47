/* test.h - TEST(name) { ... } defines a test, which ends by free_simulations.
 * TESTS(setup, teardown), functions or NULL, ends the file. Tests run in their
 * order; a suite's argument chooses tests by name (* for any letters). */
#ifndef ELASTO_TEST_H
#define ELASTO_TEST_H

#include "oracle.h"

static struct CMUnitTest test_list[128];
static size_t test_count;

#define TEST(name)                                                             \
    static void name(void);                                                    \
    static void name##_runs(void **unused)                                     \
    {                                                                          \
        (void)unused;                                                          \
        name();                                                                \
        free_simulations();                                                    \
    }                                                                          \
    __attribute__((constructor)) static void name##_is_listed(void)            \
    {                                                                          \
        test_list[test_count++] =                                              \
            (struct CMUnitTest){#name, name##_runs, NULL, NULL, NULL};         \
    }                                                                          \
    static void name(void)

#define TESTS(setup, teardown)                                                 \
    int main(int argc, char **argv)                                            \
    {                                                                          \
        if (argc > 1)                                                          \
            cmocka_set_test_filter(argv[1]);                                   \
        return _cmocka_run_group_tests(__BASE_FILE__, test_list, test_count,   \
                                       setup, teardown);                       \
    }

#endif
