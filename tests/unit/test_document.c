/* test_document.c - documents: the text beside the canvas of the web page, for
 * all pages of the lecture and all scenes */
#include "attended.h"
#include "picture/picture.h"
#include "scenes/scenes.h"
#include "test.h"
#include "web/document.h"

static char text[DOCUMENT_SIZE];

static void write_document(void)
{
    player_build_frame(&player);
    document_write(&player, text);
}

static int count_lines(const char *word)
{
    size_t length = strlen(word);
    int count = 0;
    for (const char *line = text; *line; line = strchr(line, '\n') + 1)
        count += strncmp(line, word, length) == 0 && line[length] == '\t';
    return count;
}

/* Checks each line's number of fields by its first word, and the braces. */
static void check_document_lines(void)
{
    static const struct {
        const char *word;
        int field_count; /* number of fields; 0: depends on the columns */
    } words[] = {
        {"page", 3},  {"topic", 1},  {"sentence", 1}, {"time", 1},
        {"told", 2},  {"step", 3},   {"text", 3},     {"formula", 3},
        {"ask", 3},   {"asks", 2},   {"look", 3},     {"try", 3},
        {"claim", 3}, {"notes", 3},  {"code", 2},     {"verdict", 3},
        {"card", 6},  {"words", 4},  {"row", 6},      {"number", 8},
        {"point", 3}, {"switch", 3}, {"picture", 1},  {"event", 1},
        {"cells", 0}, {"legend", 0},
    };
    assert_true(strlen(text) < DOCUMENT_SIZE - 100);
    for (char *line = text, *end; *line; line = end + 1) {
        size_t word = strcspn(line, "\t\n"), row = 0;
        int fields = 0, depth = 0;
        end = strchr(line, '\n');
        while (row < sizeof words / sizeof *words &&
               (strlen(words[row].word) != word ||
                strncmp(line, words[row].word, word) != 0))
            row++;
        assert_true(row < sizeof words / sizeof *words);
        for (const char *at = line; at < end; at++) {
            fields += *at == '\t';
            depth += (*at == '{') - (*at == '}');
            assert_true(depth >= 0 || strncmp(line, "code", 4) == 0);
        }
        if (words[row].field_count == 0)
            assert_in_range(fields, 3, 2 + CARD_COLUMNS);
        else
            assert_int_equal(fields, words[row].field_count);
        assert_true(depth == 0 || strncmp(line, "code", 4) == 0);
    }
}

TEST(a_page_keeps_its_answer_until_the_guess)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        char line[64];
        snprintf(line, sizeof line, "--lecture %s", page->name);
        begin_player(line);
        player.setup.asks_guess = true;
        write_document();
        check_document_lines();
        assert_true(count_lines("topic") == 1 && count_lines("text") > 0);
        CHECK((count_lines("ask") > 0) == (page->question != NULL));
        assert_int_equal(count_lines("asks"), page->question != NULL);
        if (page->question)
            assert_int_equal(count_lines("look") + count_lines("try"), 0);
        CHECK_OK(player_reveal_answer(&player, NULL));
        CHECK_OK(player_obey_queue(&player, false));
        write_document();
        check_document_lines();
        assert_int_equal(count_lines("asks"), 0);
        CHECK(count_lines("look") > 0 && count_lines("code") > 0);
        if (page->try && strstr(page->try, "Set ")) /* the task sets a number */
            assert_non_null(strstr(text, "\ttried\n"));
        end_player();
    }
}

TEST(scenes_have_numbers_and_a_picture_in_words)
{
    for (const Scene *scene = scenes; scene->name; scene++) {
        begin_player(scene->name);
        write_document();
        check_document_lines();
        CHECK(count_lines("number") > 0 && count_lines("picture") == 1);
        assert_int_equal(count_lines("ask") + count_lines("look"), 0);
        end_player();
    }
}

TEST(an_event_tells_the_change_of_E_and_legends_name_the_curves)
{
    begin_player("square --steps 1");
    CHECK_OK(player_make_step(&player));
    write_document();
    assert_non_null(strstr(text, "\nevent\tstep 1: 3 updates, E fell by "));
    assert_non_null(strstr(text, "\tquadratic model\n"));
    assert_non_null(strstr(text, "\telastic\t"));
    end_player();
}

TEST(a_table_is_text_after_the_guess)
{
    begin_player("--lecture step");
    player.setup.asks_guess = true;
    write_document();
    assert_int_equal(count_lines("cells"), 0);
    assert_non_null(strstr(text, "prints\tcovered\t"));
    CHECK_OK(player_reveal_answer(&player, NULL));
    CHECK_OK(player_obey_queue(&player, false));
    CHECK_OK(player_make_step(&player));
    write_document();
    assert_true(count_lines("cells") > 4); /* rows: heads, updates, end */
    assert_non_null(strstr(text, ": the loop ends\t"));
    CHECK_OK(obey_command("set stretch 1"));
    CHECK_OK(player_make_step(&player));
    write_document();
    assert_int_equal(count_lines("cells"), 3); /* rows: heads, update, end */
    end_player();
}

TEST(lists_have_all_pages_and_scenes)
{
    document_write_lists(text);
    assert_int_equal(count_lines("pages"), lecture_count_pages());
    assert_true(count_lines("scenes") == 18 && count_lines("keys") > 20);
}

TESTS(NULL, NULL)
