#!/bin/sh
# Every number in the texts of all pages and scenes, calculated again by a program
# that shares nothing with ours (frame_numbers.py).
set -u
texts=$(dirname "${ELASTO:-build/release/elasto}")/tests/unit/texts
[ -x "$texts" ] || texts=build/release/tests/unit/texts
for python in python3 /usr/bin/python3; do
    if "$python" -c 'import numpy' 2>/dev/null; then
        PYTHONDONTWRITEBYTECODE=1 exec "$python" \
            "$(dirname "$0")/frame_numbers.py" "$texts" ${LONG:+long}
    fi
done
echo "skipped numbers: needs python3 with numpy"
