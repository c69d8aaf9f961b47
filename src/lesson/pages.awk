# pages.awk - turns pages.txt, whose head describes it, into the tables of pages.h.

# Returns bits of PictureLayer in C.  text: names of layers, separated by blanks.
function layers_of(text,    i, n, name, bits)
{
    n = split(text, name, " ")
    for (i = 1; i <= n; i++) {
        if (!(name[i] in layers))
            fail(begins, "there is no layer " name[i])
        bits = bits (i > 1 ? " | " : "") "LAYER_" toupper(name[i])
    }
    return bits
}

# Replaces {page:NAME} by the number of that page.
function with_numbers(text,    name)
{
    while (match(text, /[{]page:[a-z0-9]+[}]/)) {
        name = substr(text, RSTART + 6, RLENGTH - 7)
        if (!(name in place))
            fail(begins, "there is no page " name)
        text = substr(text, 1, RSTART - 1) place[name] \
               substr(text, RSTART + RLENGTH)
    }
    return text
}

# Reads the names of all pages: place[name] is the number of the page.
function read_names(file,    line)
{
    while ((getline line < file) > 0)
        if (line ~ /^== [a-z0-9]+: ./)
            place[substr(line, 4, index(line, ":") - 4)] = ++pages
    close(file)
}

# Adds the lines of one word, which `text` has joined, to the row of the page.
function put_word(    part)
{
    if (word in prose)
        text = with_numbers(text)
    if (word == "skip") # before the first page
        asides = asides (asides ? "|" : "") text
    else if (word == "lit" && split(text, part, " ") >= 3)
        walk[part[1]] = walk[part[1]] "[" part[2] "] = " \
            quoted(substr(text, length(part[1] part[2]) + 3)) ", "
    else if (word == "letter" && (part[0] = index(text, ": ")))
        letters = letters "{" quoted(substr(text, 1, part[0] - 1)) ", " \
                  quoted(substr(text, part[0] + 2)) "},\n"
    else if (word == "text" || word == "formula" || word == "look") # in lines
        below[word] = below[word] (below[word] ? " \"\\n\" " : "") quoted(text)
    else if (word in texts)
        print "." texts[word] " = " quoted(text) ","
    else if (word in numbers && text ~ /^[0-9.]+$/)
        print "." numbers[word] " = " text ","
    else if (word == "extra" && text == "")
        print ".is_extra = true,"
    else if (word == "layers")
        print ".layers = " layers_of(text) ","
    else if (word == "next" && text in of_next)
        print ".next_action = NEXT_" of_next[text] ","
    else if (word == "code" && split(text, part, " ") >= 3)
        print ".file = " quoted(part[1]) ", .functions = " quoted(part[2]) \
              ", .highlight_text = " \
              quoted(substr(text, length(part[1] part[2]) + 3)) \
              ", .code = (const char *const[]){" \
              code_of(part[1], part[2]) "NULL}," \
              (part[2] in walk ? ".line_highlight = (const char *const[PAGE_HIGHLIGHT_COUNT]){" \
                                 walk[part[2]] "}," : "")
    else if (word != "" && word != "minutes") # minutes are for readers only
        fail(begins, "'" word " " text "' is nothing that a page has")
    had[word] = 1
    word = ""
}

function end_page(    i)
{
    put_word()
    for (i in needed)
        if (page && !(needed[i] in had))
            fail(page, "the page has no " needed[i])
    for (i in below)
        print "." (i == "look" ? "answer_text" : i == "text" ? "intro" : i) " = " below[i] ","
    split("", below)
    if (page)
        print "},"
    split("", had)
}

BEGIN {
    split("text run cards look try code claim notes", needed)
    split("claim main_card notes section", same)
    for (i in same)
        texts[same[i]] = same[i]
    texts["answer"] = "answer_name"
    texts["cards"] = "open_cards"
    texts["run"] = "command_line"
    texts["try"] = "try"
    texts["ask"] = "question"
    texts["open"] = "on_open"
    texts["tell"] = "on_answer"
    texts["veils"] = "covered_cards"
    texts["law"] = "law_name"
    prose["text"] prose["ask"] prose["look"] prose["try"] prose["notes"]
    read_names(ARGV[1])
    numbers["picture"] = "printed_step"
    numbers["lines"] = "key_presses"
    numbers["speed"] = "speed"
    numbers["flips"] = "switch_flips"
    numbers["pause"] = "pause_step"
    of_next["shorten"] = "SHORTENS_SPRING"
    of_next["spring"] = "ADDS_SPRING"
    split("node_numbers forces modes spring_kinds filled_cells downhill " \
          "zero_curves first_step", layer)
    for (i in layer)
        layers[layer[i]]
}

/^== [a-z0-9]+: ./ {
    end_page()
    if (!page)
        print "const LecturePage lecture_pages[] = {"
    page = NR
    colon = index($0, ":")
    print "{.name = " quoted(substr($0, 4, colon - 4)) ","
    print ".topic = " quoted(substr($0, colon + 2)) ","
    next
}

{ begin_word(page || $1 ~ /^(skip|lit|letter)$/, "no page has begun") }

END {
    end_page()
    print "{.name = NULL}};"
    print "const SlideLetter lecture_letters[] = {\n" letters "{NULL, NULL}};"
    exit failed
}
