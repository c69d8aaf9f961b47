# Writes homework.c: lecture.c without the bodies of the functions in tasks.txt.
#   awk -f write.awk tasks.txt ../lecture.c

BEGIN {
    print "/* homework.c - the lecture's program with eleven functions to" \
          " write, each\n * marked TASK.  The file compiles as it is.  `make" \
          " check-homework` says which\n * functions are right. */"
}

# tasks.txt has paragraphs: the name of a function, then what to do.
NR == FNR && $0 == "" { name = ""; next }
NR == FNR && name == "" { name = $0; next }
NR == FNR {
    task[name] = task[name] "\n     * " $0
    next
}

/^static [A-Za-z].*[ *][a-z_]+\(/ {
    name = $0
    sub(/\(.*/, "", name)
    sub(/.*[ *]/, "", name)
    result = $2
}

skipped && /^}/ { skipped = 0 }
skipped { next }
{ print }
/^{/ && name in task {
    printf "    /* TASK %d%s */\n", ++count, task[name]
    if (result == "double")
        print "    return 0;"
    skipped = 1
}
