# code.awk - for pages.awk: the functions that a page shows, as they stand in
# their source, without what a class reads past.

# The lines of a source, which is read once, into source[file, 1 ...].
function read_source(file,    line)
{
    if (file in lines)
        return
    for (lines[file] = 0; (getline line < file) > 0;)
        source[file, ++lines[file]] = line
    close(file)
}

# The line with the closing brace of what begins here; 0: a declaration, for it
# ends before a brace.
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

# The first line of the function, 0: there is none.  It is named outside of any
# body: in column 1 stands a type, and the name before a parenthesis.
function find_function(file, name,    i)
{
    for (i = 1; i <= lines[file]; i++)
        if (source[file, i] ~ "^([A-Za-z].*[ *])?" name "[(]" && \
            find_end(file, i))
            return i
    return 0
}

# How many lines from this one on begin with what no page shows (asides), a
# condition before them included.
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

# The lines of these functions, with ',' between the names, a blank one between
# the functions, as the elements of an array.
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
