#!/bin/sh
# libraries.sh FOLDER: CHOLMOD, FreeType, libpng and zlib as archives of
# WebAssembly, from the unchanged sources of Debian 12, which stay in the folder.
set -eu
mkdir -p "$1/sources" "$1/include"
cd "$1" # names are from here on, so that the page is the same in any folder

# The mirror that apt uses; a file of another checksum is refused.
mirror=$(apt-get --print-uris download node-acorn |
    sed -n "s|^'\(.*\)/pool/.*|\1|p")
source() { # where in the pool, checksum; its folder goes to $from
    file=sources/${1##*/}
    name=${file%%_*}
    [ -f "$file" ] || {
        /usr/lib/apt/apt-helper -qq -o APT::Sandbox::User="$(id -un)" \
            download-file "$mirror/pool/main/$1" "$file.new" "SHA256:$2"
        mv "$file.new" "$file"
    }
    rm -rf "$name"
    mkdir "$name"
    tar -xf "$file" -C "$name" --strip-components=1
    from=$name
}

# One archive of these files.
archive() { # name, flags, sources
    name=$1
    flags=$2
    shift 2
    mkdir -p "$name/objects"
    printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} sh -c "emcc -O2 -msimd128 \
        -mbulk-memory -ffp-contract=off -w $flags -c {} \
        -o $name/objects/\$(basename {} .c).o"
    emar rcs "lib$name.a" "$name"/objects/*.o
}

source s/suitesparse/suitesparse_5.12.0+dfsg.orig.tar.xz \
    bb106c43049138c19675cd70322e72ff8e4fd8bdcab3a096307fd78488913faf
cp "$from"/CHOLMOD/Include/*.h "$from"/AMD/Include/*.h \
    "$from"/COLAMD/Include/*.h "$from"/SuiteSparse_config/*.h include
archive suitesparse "-DNPARTITION -DNTIMER -DNPRINT -DNMODIFY -DNMATRIXOPS \
    -Iinclude -I$from/CHOLMOD/Core -I$from/CHOLMOD/Supernodal \
    -I$from/CHOLMOD/Cholesky" "$from"/AMD/Source/*.c \
    "$from"/COLAMD/Source/colamd.c "$from"/CHOLMOD/Core/cholmod_*.c \
    "$from"/CHOLMOD/Cholesky/cholmod_*.c \
    "$from"/CHOLMOD/Supernodal/cholmod_*.c \
    "$from"/SuiteSparse_config/SuiteSparse_config.c

source z/zlib/zlib_1.2.13.dfsg.orig.tar.bz2 \
    71feb7947e3c00ef125f83b79a4e529bde31171e5babe48b391f06758d1ab0a1
cp "$from"/zlib.h "$from"/zconf.h include
archive zlib -Iinclude "$from"/adler32.c "$from"/compress.c "$from"/crc32.c \
    "$from"/deflate.c "$from"/inf*.c "$from"/trees.c "$from"/zutil.c

source libp/libpng1.6/libpng1.6_1.6.39.orig.tar.gz \
    a00e9d2f2f664186e4202db9299397f851aea71b36a35e74910b8820e380d441
rm -f "$from"/pngtest.c
cp "$from"/png.h "$from"/pngconf.h include
cp "$from"/scripts/pnglibconf.h.prebuilt include/pnglibconf.h
archive libpng1.6 -Iinclude "$from"/png*.c

# Of FreeType only what draws TrueType's outlines with the light autohinter.  It
# walks along curves in 64 bits where it knows that the processor can, which for
# the same pixels as elsewhere has to be said (_M_ARM64).
source f/freetype/freetype_2.12.1+dfsg.orig.tar.xz \
    7dedb6b9adf331559daea614a83b8de42a753e685ec8e1c4bdb4529eb880b0d1
cp -R "$from"/include/* include
sed -i 's,^#define FT_CONFIG_OPTION_USE_ZLIB,//&,
    s,^#define TT_CONFIG_OPTION_COLOR_LAYERS,//&,' \
    include/freetype/config/ftoption.h
cat >include/modules_of_the_page.h <<'END'
FT_USE_MODULE(FT_Driver_ClassRec, tt_driver_class)
FT_USE_MODULE(FT_Module_Class, sfnt_module_class)
FT_USE_MODULE(FT_Module_Class, autofit_module_class)
FT_USE_MODULE(FT_Module_Class, psnames_module_class)
FT_USE_MODULE(FT_Renderer_Class, ft_smooth_renderer_class)
END
archive freetype "-DFT2_BUILD_LIBRARY -DFT_CONFIG_OPTION_SUBPIXEL_RENDERING \
    -D_M_ARM64 '-DFT_CONFIG_MODULES_H=<modules_of_the_page.h>' -Iinclude" \
    "$from"/src/base/ftbase.c "$from"/src/base/ftsystem.c \
    "$from"/src/base/ftinit.c "$from"/src/base/ftdebug.c \
    "$from"/src/base/ftglyph.c "$from"/src/base/ftbitmap.c \
    "$from"/src/truetype/truetype.c "$from"/src/sfnt/sfnt.c \
    "$from"/src/autofit/autofit.c "$from"/src/smooth/smooth.c \
    "$from"/src/psnames/psnames.c
