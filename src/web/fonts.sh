#!/bin/sh
# fonts.sh FOLDER: DejaVu Sans, Bold and Mono with the letters that the sources
# can write, and those that FreeType's autohinter measures: Latin, Greek,
# superscripts.  Whatever a letter of ours looks like depends on these alone.
set -eu
mkdir -p "$1"
letters=$(cat src/*.c src/*/*.c src/lesson/pages.txt src/picture/cards.txt include/*/*.h | python3 -c '
import re, sys
text = sys.stdin.read()
text += "".join(chr(int(code, 16)) for code in re.findall(r"\\u(\w{4})", text))
print(",".join("U+%04X" % ord(c) for c in sorted(set(text)) if ord(c) > 0x17f))')
measured=U+0020-007E,U+00A0-017F,U+02B0-02B8,U+02E0-02E4,U+0300-03FF
measured=$measured,U+1D2C-1D6A,U+2070-209C,U+FFFD
for face in DejaVuSans DejaVuSans-Bold DejaVuSansMono; do
    pyftsubset "/usr/share/fonts/truetype/dejavu/$face.ttf" \
        --output-file="$1/$face.ttf" --unicodes="$measured,$letters" \
        --layout-features='' --no-hinting --notdef-outline --glyph-names \
        --drop-tables+=FFTM
done
