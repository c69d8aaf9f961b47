/* hints.c - hints for users who mistyped a name or used a removed option. */
#include "lesson/hints.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "simulation/message.h"

Phrase join_names(NameTable names)
{
    Phrase list = {""};
    const char *name;
    for (int i = 0; (name = names_get(names, i)); i++)
        append(list.text, sizeof list.text, "%s%s", i > 0 ? ", " : "", name);
    return list;
}

/* ---- mistyped names ----------------------------------------------------- */

/* Whether a typed letter is that of a name, in any case, with '_' as '-'. */
static bool letters_match(char typed, char letter)
{
    return tolower((unsigned char)typed) == tolower((unsigned char)letter) ||
           (typed == '_' && letter == '-');
}

enum {
    MAX_COMPARED_LETTERS = 24, /* largest number of letters that are compared */
    MAX_SHORT_NAME_LETTERS = 4 /* longest text whose first letter must fit */
};

/* Number of typing mistakes (Damerau 1964) between a text, of at most
 * MAX_COMPARED_LETTERS, and a name or its beginning, so that "seg" fits
 * segments.  A mistake is a letter too many, missing or wrong, or two letters
 * exchanged. */
static int count_typing_errors(const char *text, const char *name)
{
    /* [i][j]: mistakes between i letters of the text and j of the name */
    int least[MAX_COMPARED_LETTERS + 1][MAX_COMPARED_LETTERS + 1];
    int rows = (int)strlen(text),
        columns = (int)strnlen(name, MAX_COMPARED_LETTERS);
    for (int i = 0; i <= rows; i++)
        for (int j = 0; j <= columns; j++) {
            least[i][j] = i + j;
            if (i == 0 || j == 0)
                continue;
            bool same = letters_match(text[i - 1], name[j - 1]);
            bool exchanged = i > 1 && j > 1 &&
                             letters_match(text[i - 1], name[j - 2]) &&
                             letters_match(text[i - 2], name[j - 1]);
            double best = fmin(least[i - 1][j], least[i][j - 1]) + 1;
            best = fmin(best, least[i - 1][j - 1] + !same);
            best = exchanged ? fmin(best, least[i - 2][j - 2] + 1) : best;
            least[i][j] = (int)best;
        }
    int best = rows;
    for (int j = 0; j <= columns; j++)
        best = least[rows][j] < best ? least[rows][j] : best;
    return best;
}

/* A name of an option or of a value, and words that mean the same in other
 * programs, in books or in lecture.c, each between two blanks. */
static const struct SynonymRow {
    const char *name, *synonyms;
} synonyms[] = {
    {"timestep", " h dt "},
    {"stiffness", " k "},
    {"density", " rho mass "},
    {"young", " e "},
    {"poisson", " nu "},
    {"friction", " mu "},
    {"damping", " eta "},
    {"gravity", " g "},
    {"integrator", " method "},
    {"segments", " n_seg n resolution "},
    {"side", " side_len "},
    {"barrier", " kappa dhat "},
    {"tolerance", " eps "},
    {"steps", " duration time "},
    {"film", " record video "},
    {"states", " output o "},
    {"size", " width height "},
    {"headless", " no-window no-gui batch "},
    {"stretch", " initial_stretch "},
    {"backward-euler", " euler implicit implicit-euler "},
    {"forward-euler", " explicit explicit-euler "},
    {"symplectic-euler", " semi-implicit-euler "},
    {"verlet", " leapfrog velocity-verlet "},
    {"newton", " cholesky "},
    {"backtrack", " armijo on "},
    {"none", " off "},
    {"clamp", " psd "},
    {"on", " yes true 1 "},
    {"off", " no false 0 "},
    {"neo-hookean", " triangles solid "},
};

/* A text of n > 2 letters may have (n + 1)/3 mistakes, rounded down.  A text of
 * at most MAX_SHORT_NAME_LETTERS must have the right first letter. */
Phrase suggest_name(const char *text, const char *dashes, NameTable names)
{
    Phrase hint = {""};
    const char *name, *meant = NULL;
    char word[MAX_COMPARED_LETTERS + 3];
    int letters = (int)strlen(text);
    int fewest = letters > 2 ? (letters + 1) / 3 + 1 : 1;
    bool is_comparable = letters > 1 && letters <= MAX_COMPARED_LETTERS;
    for (int i = 0; is_comparable && (name = names_get(names, i)); i++) {
        int mistakes = count_typing_errors(text, name);
        if (name[0] && mistakes < fewest &&
            (letters > MAX_SHORT_NAME_LETTERS ||
             letters_match(text[0], name[0]))) {
            fewest = mistakes;
            meant = name;
        }
    }
    snprintf(word, sizeof word, " %s ", text);
    for (size_t i = 0; i < sizeof synonyms / sizeof *synonyms; i++)
        if (strcasestr(synonyms[i].synonyms, word) &&
            names_find(names, synonyms[i].name) >= 0)
            meant = synonyms[i].name;
    if (meant)
        append(hint.text, sizeof hint.text, "; did you mean %s%s?", dashes,
               meant);
    return hint;
}

/* ---- removed options ---------------------------------------------------- */

#define KEEPS_ENERGY                                                           \
    "verlet, or midpoint with a small --tolerance, keeps the energy in the "   \
    "mean"

/* Options, and values of options, that an earlier version had; "": the whole
 * option.  A row stays for one release, so that users learn what to use. */
static const struct RemovedOption {
    const char *option, *value; /* removed option; its value, or "" */
    const char *replacement;    /* end of a message: what to use now */
} removed[] = {
    {"vtk", "", "--states and --springs write each step as CSV"},
    {"integrator", "avf", KEEPS_ENERGY},
    {"integrator", "avf4", KEEPS_ENERGY},
    {"minimum", "", "a step may end on a saddle of E; nothing replaces it"},
    {"handout", "", "print the page, or make handout"},
    {"notes", "", "elasto.html?notes is the page with the notes"},
};

const char *find_replacement(const char *option, const char *value)
{
    for (size_t i = 0; i < sizeof removed / sizeof *removed; i++)
        if (strcmp(removed[i].option, option) == 0 &&
            strcmp(removed[i].value, value) == 0)
            return removed[i].replacement;
    return NULL;
}
