# text.awk - reads lines that begin with a word, and the lines that continue them,
# for pages.awk and cards.awk, which follow this file on the command line.

# Reports a mistake.  Reading goes on, so that all mistakes are reported; the last
# END then returns 1.
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

# Begins the text of a word.
#   made  whether a row has begun
#   none  the mistake if no row has begun
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
