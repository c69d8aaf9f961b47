#!/bin/sh
# fonts.sh FOLDER: DejaVu Sans, Bold and Mono with the letters that the sources
# can write, and those that FreeType's autohinter measures: Latin, Greek,
# superscripts.  FOLDER.woff is DejaVu Math for the page's MathML, which needs
# the italic letters and some signs.
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
math=U+0020-007E,U+00A0,U+00A8,U+00AF,U+00B0,U+00B7,U+00BC,U+00BD,U+02D9
math=$math,U+0391-03C9,U+2016,U+2026,U+2032,U+2033,U+2190-2192,U+2202,U+2207
math=$math,U+2211,U+2212,U+221A,U+221E,U+222B,U+2248,U+2260,U+2264,U+2265
math=$math,U+22C5,U+22EE,U+22EF,U+22F1,U+1D434-1D467,U+210E,U+1D6E2-1D71B
pyftsubset /usr/share/fonts/truetype/dejavu/DejaVuMathTeXGyre.ttf \
    --output-file="$1.woff" --flavor=woff --unicodes="$math" \
    --layout-features='' --no-hinting --drop-tables+=FFTM
