# cards.awk - turns cards.txt, whose head describes it, into the tables of cards.h.

# Adds the lines of one word to the row, as a field.
function put_word(    i, part)
{
    if (word in texts)
        texts[word] = texts[word] (texts[word] ? " \"\\n\" " : "") quoted(text)
    else if (word in values && text != "")
        row = row "." word " = " (word == "default_bounds" ? "{" text "}" : text) ", "
    else if (word == "name")
        called = text
    else if (word == "rows")
        row = row ".listing = rows_" text ", "
    else if (word == "line" && kind == "rows") {
        end_line()
        split(text, part, " ")
        row = ".at_line = LINE_" part[1] ", .shown_if = " \
              quoted(substr(text, length(part[1]) + 2)) ", "
    } else if (word == "cards")
        for (i = split(text, part, " "); i > 0; i--)
            list = "&card_" part[i] ", " list
    else if (word in switches && text == "")
        row = row "." word " = true, "
    else if (word != "")
        fail(begins, "'" word " " text "' is nothing that a " kind " has")
    word = ""
}

# Ends a row: adds its texts after its other fields, and prints it.
function put_texts(    i)
{
    for (i in texts) {
        if (texts[i])
            row = row "." i " = " texts[i] ", "
        texts[i] = ""
    }
}

function end_line()
{
    put_texts()
    if (row)
        list = list "{" row "},\n"
    row = ""
}

function end_row()
{
    put_word()
    if (kind == "text")
        print "const char text_" name "[] = " texts["words"] ";"
    if (kind == "rows") {
        end_line()
        print "const ListingRow rows_" name "[] = {" list "{.shown_if = NULL}};"
    }
    put_texts()
    if (kind == "card")
        print "const Card card_" name " = {" row ".name = " quoted(called) "};"
    if (kind == "picture") {
        lists = lists "static const Card *const " name "_cards[] = {" list "};\n"
        rows = rows "[PICTURE_" toupper(name) "] = {" row ".cards = " name \
               "_cards, .card_count = sizeof " name "_cards / sizeof *" name "_cards},\n"
    }
    row = list = ""
}

BEGIN {
    texts["title"] texts["legend"] texts["words"] texts["column_heads"]
    texts["text"] texts["value"] texts["crossed_out_if"]
    values["min_height"] values["find_least_height"] values["height_weight"] values["main_place"] values["default_bounds"]
    values["draw"] values["make_row"] values["find_bounds"] values["add_values"] values["pick"]
    values["draw_hover_note"] values["get_energies"] values["make_legend_row"]
    switches["is_text_only"] switches["fits_half_width"] switches["fits_half_page"]
    switches["starts_closed"] switches["needs_line_energy"] switches["is_only_in_lecture"]
    switches["is_stretched"] switches["draws_handles"] switches["takes_clicks"]
    switches["shows_scale_bar"] switches["is_indented"]
    print "#include \"picture/cards.h\""
}

/^== (card|picture|rows|text) [a-z_]+$/ {
    end_row()
    kind = $2
    called = name = $3
    next
}

{ begin_word(kind, "no row has begun") }

END {
    end_row()
    print lists "const Picture pictures[PICTURE_COUNT] = {\n" rows "};"
    exit failed
}
