# code.awk - finds the functions that a page shows in their sources, for
# pages.awk, and leaves out lines that explain nothing (`skip` of pages.txt).

# Reads the lines of a source, once, into source[file, 1 ...].
function read_source(file,    line)
{
    if (file in lines)
        return
    for (lines[file] = 0; (getline line < file) > 0;)
        source[file, ++lines[file]] = line
    close(file)
}

# Returns the line with the closing brace of the definition that begins at
# `from`; 0: a declaration begins there, which has no brace.
function find_end(file, from,    i, line, body)
{
    for (i = from; i <= lines[file]; i++) {
        line = source[file, i]
        if (line ~ /^[}]/ || (!body && line ~ /[}]$/))
            return i
        if (!body && line ~ /;$/)
            return 0
        body = body || line ~ /^[{]/
    }
    return 0
}

# Returns the first line of a function's definition, 0: there is none.  That line
# begins with a type in column 1, and the name is followed by a parenthesis.
function find_function(file, name,    i)
{
    for (i = 1; i <= lines[file]; i++)
        if (source[file, i] ~ "^([A-Za-z].*[ *])?" name "[(]" && \
            find_end(file, i))
            return i
    return 0
}

# Returns how many lines from `at` on no page shows: a statement or comment that
# begins with one of `asides`, together with the condition before it.
function count_asides(file, at,    line, heads, count, ending)
{
    line = source[file, at]
    heads = line ~ /^ *(if \(|for \(|else$)/ && line !~ /[{]/
    for (count = 0; count <= heads; count++) {
        line = source[file, at + count]
        sub(/^ */, "", line)
        if (line !~ "^(" asides ")")
            continue
        ending = line ~ /^\/[*]/ ? "*/" : ";"
        while (!index(source[file, at + count], ending) && \
               at + count < lines[file])
            count++
        return count + 1
    }
    return 0
}

# Returns the lines of functions as elements of a C array, with an empty line
# between two functions.  names: separated by ','.
function code_of(file, names,    i, n, name, at, end, skipped, last, line, code)
{
    read_source(file)
    n = split(names, name, ",")
    for (i = 1; i <= n; i++) {
        at = find_function(file, name[i])
        if (!at)
            fail(begins, "there is no function " name[i] " in " file)
        end = at ? find_end(file, at) : -1
        code = code (code != "" ? "\"\",\n" : "")
        while (at <= end) {
            skipped = count_asides(file, at)
            at += skipped
            if (last ~ /^[{]/ && source[file, at] == "")
                at++
            if (skipped)
                continue
            last = source[file, at++]
            line = last
            gsub(/[\\"]/, "\\\\&", line)
            code = code "\"" line "\",\n"
        }
        last = ""
    }
    return code
}
