# text.awk - what pages.awk and cards.awk, which stand behind it, read alike: words
# at the beginning of a line, with the lines that go on with them.

# What is wrong is said, all of it; the last END then ends with 1.
function fail(line, why)
{
    print FILENAME ":" line ": " why > "/dev/stderr"
    failed = 1
}

function quoted(text)
{
    gsub(/[\\"]/, "\\\\&", text)
    gsub(/~/, "\302\240", text)
    return "\"" text "\""
}

# A word of a row begins; made: whether there is a row.
function begin_word(made, none)
{
    if (!made)
        fail(NR, none)
    put_word()
    begins = NR
    word = $1
    text = substr($0, length(word) + 2)
}

/^#/ || /^$/ { next }

/^  / {
    if (word == "")
        fail(NR, "nothing goes on here")
    text = text " " substr($0, 3)
    next
}
