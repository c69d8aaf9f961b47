/* type.c - what is typed: into the selected number, or of a page of their list.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"

Keyboard player_keyboard(const Player *player)
{
    bool number = player->selected >= 0 && player->selected < player->numbers;
    bool list = player->column == COLUMN_PAGES;
    if (player->typing && (number || list))
        return AT_FIELD;
    return number ? AT_NUMBER : list ? AT_LIST : AT_RUN;
}

void player_deselect(Player *player)
{
    player->selected = -1;
    player->typing = false;
    player->typed[0] = '\0';
}

/* The letter that a key types; "": none.  letter [size] out */
static void key_letter(const char *key, char *letter, size_t size)
{
    bool shift = strncmp(key, "Shift+", 6) == 0;
    const char *name = shift ? key + 6 : key;
    bool one = name[0] && (!name[1] || (unsigned char)name[0] >= 0x80);
    snprintf(letter, size, "%.4s",
             strcmp(name, "Space") == 0 ? " "
             : one                      ? name
                                        : "");
    if (one && !shift && name[0] >= 'A' && name[0] <= 'Z')
        letter[0] = (char)(name[0] - 'A' + 'a');
}

/* One letter more or less.  The first one opens the field. */
Status type(Player *player, const Command *command)
{
    char *typed = player->typed, letter[8];
    if (!player->typing)
        typed[0] = '\0';
    player->typing = true;
    size_t length = strlen(typed);
    key_letter(command->text, letter, sizeof letter);
    if (strcmp(command->text, "Backspace") == 0) {
        while (length > 0 && ((unsigned char)typed[--length] & 0xc0) == 0x80)
            continue; /* of a letter of several bytes */
        typed[length] = '\0';
    } else if (length + strlen(letter) < sizeof player->typed) {
        strcat(typed, letter);
    } else {
        player_note(player,
                    "there is room for %zu letters: Enter sets the "
                    "number, Esc leaves it",
                    sizeof player->typed - 1);
        return STATUS_OK;
    }
    if (player->selected >= 0)
        player_note(player, "a number is typed: Enter sets it, Esc leaves it");
    else
        player_note(player, "page %s_: Enter opens it, Esc leaves it", typed);
    return STATUS_OK;
}

/* The page is opened, or the number is set; what cannot be read leaves the
 * field as it is. */
Status enter(Player *player, const Command *command)
{
    (void)command;
    const bool page = player->selected < 0;
    const OptionRow *row = page ? NULL : player->number[player->selected];
    Command made = {.kind = page ? COMMAND_PAGE : COMMAND_SET, .joins = true};
    char read[COMMAND_TEXT_SIZE] = "", note[sizeof player->note], unit[16];
    char typed[sizeof player->typed];
    memcpy(typed, player->typed, sizeof typed);
    memcpy(made.text, typed, sizeof typed);
    if (row) {
        made.number = row - option_rows;
        if (option_read(row, typed, &made.x))
            made.text[0] = '\0';
        option_write(row, made.x, read, sizeof read);
    }
    Status status = player_obey(player, &made);
    if (status)
        return status;
    player_deselect(player);
    if (!row || strcmp(typed, read) == 0)
        return STATUS_OK;
    memcpy(note, player->note, sizeof note);
    option_unit(row, unit, sizeof unit);
    player_note(player, "%s is read as %.4g%s%s%s%s", typed, made.x,
                unit[0] ? " " : "", unit, note[0] ? "; " : "", note);
    return STATUS_OK;
}

Status close_field(Player *player, const Command *command)
{
    (void)command;
    player_deselect(player);
    return STATUS_OK;
}
