# Compiler options that every target of the project shares.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
    # Without this ccache does not take sources with precompiled headers.
    set(launcher ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
    set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
    set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
endif()

# Virtual-time runs must be byte-identical between presets and processors: no contraction of
# a*b+c, no fast-math, and no asserts that change what is computed.
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)

set(TAKT_SANITIZE "" CACHE STRING "sanitizers, for example address,undefined or thread")
if(TAKT_SANITIZE)
    add_compile_options(-fsanitize=${TAKT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -O1 -g1)
    add_link_options(-fsanitize=${TAKT_SANITIZE})
endif()

add_library(takt_warnings INTERFACE)
target_compile_options(takt_warnings INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wshadow;-Wnon-virtual-dtor;-Werror=return-type>)
