#!/bin/sh
# Checks the lecture without a screen: its list and its pages one by one.
. "$(dirname "$0")/verdict.sh"
work_apart
apart=$PWD

"$elasto" --lecture --list >list
pages=$(awk 'END { print NR }' list)

# Runs pages from the last to the first: no page needs an earlier one.
verdict every_page_opens_by_number_and_by_name "$(
    awk '{ print $2 }' list >names
    while read -r name; do
        timeout 300 "$elasto" --lecture "$name" --headless --quiet --steps 1 \
            --size 480x300 --frames "frames_$name" 2>error
        code=$?
        [ $code = 0 ] || [ $code = 3 ] || echo "$name: exit $code: $(cat error)"
        [ -s "frames_$name/frame_000000.png" ] || echo "$name: no picture"
    done <names
    timeout 300 "$elasto" --lecture "$pages" --headless --quiet --steps 0 \
        --size 480x300 --frames last
    last=$(tail -n 1 names)
    cmp last/frame_000000.png "frames_$last/frame_000000.png" 2>&1
)"

# Texts, comments and READMEs refer to pages by name: with one page more at place 3,
# each number in a text still belongs to the same page.
number='\b(pages?|pp?[.])[~*/[:space:]\xc2\xa0]*[0-9]+|[0-9] +pages\b'
numbers() { # PAGES.TXT: numbers of pages in its texts
    awk -f src/lesson/text.awk -f src/lesson/code.awk \
        -f src/lesson/pages.awk "$1" | grep -oiP "$number" | grep -o '[0-9]*$'
}
verdict a_page_more_makes_no_number_stale "$(
    cd "$root" || exit 1
    grep -rzoiP --include=*.md --include=*.[ch] --include=*.js --include=cards.txt \
        --include=pages.txt "$number" README.md src include tests | tr '\0' '\n'
    awk '/^== equation:/ { print "== added: One more"; print page }
        /^== / { page = "" }
        !/^==/ && !/page:/ { page = page $0 "\n" }
        { print }' src/lesson/pages.txt >"$apart/more.txt"
    numbers src/lesson/pages.txt | awk '{ print $1 + ($1 >= 3) }' \
        >"$apart/expected"
    numbers "$apart/more.txt" | diff "$apart/expected" - | head -n 5
    [ "$(wc -l <"$apart/expected")" -gt 3 ] || echo 'no page is named'
)"

exit $failed
