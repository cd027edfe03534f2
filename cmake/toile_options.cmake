# Rules for our own targets.  None of them reaches a project that takes Toile in: variables set here end with this folder, and the flags are
# requirements of `toile_rules`, which only targets of ours are linked with.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

option(TOILE_WERROR "a warning ends the build: for those who work on Toile; the presets say so" OFF)
set(TOILE_SANITIZE "" CACHE STRING "`address` (with undefined behaviour) or `thread`; empty: none")

add_library(toile_rules INTERFACE)
# Same source, same bits: no contraction of a*b+c, no reassociation.  They come behind CMAKE_CXX_FLAGS, and so win over what a parent or a
# packager has put there.  (docs/conventions.md#determinism)
target_compile_options(toile_rules INTERFACE -ffp-contract=off -fno-fast-math)
# For some clangs -fno-fast-math is the default again, with contraction: the last word is ours.  (SHELL: or CMake drops what it has
# seen before.)
target_compile_options(toile_rules INTERFACE $<$<CXX_COMPILER_ID:Clang,AppleClang>:SHELL:-ffp-contract=off>)
target_compile_options(toile_rules INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual
                                             $<$<BOOL:${TOILE_WERROR}>:-Werror>)
target_compile_options(toile_rules INTERFACE -fvisibility=hidden)  # what is public says TOILE_EXPORT (include/toile/export.hpp)
target_compile_definitions(toile_rules INTERFACE EIGEN_MPL2_ONLY EIGEN_DONT_PARALLELIZE)
# Eigen leaves vectors unfilled, resize() too.  With assertions they hold NaN until something is written, so that what reads them is seen.
target_compile_definitions(toile_rules INTERFACE $<$<CONFIG:Debug>:EIGEN_INITIALIZE_MATRICES_BY_NAN>)

if(TOILE_SANITIZE STREQUAL "address")
  target_compile_options(toile_rules INTERFACE
    -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_compile_definitions(toile_rules INTERFACE _GLIBCXX_ASSERTIONS)  # an index beyond a span or vector, wherever its memory ends
  target_link_options(toile_rules INTERFACE -fsanitize=address,undefined)
elseif(TOILE_SANITIZE STREQUAL "thread")
  target_compile_options(toile_rules INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_compile_definitions(toile_rules INTERFACE TOILE_THREAD_SANITIZER)
  target_link_options(toile_rules INTERFACE -fsanitize=thread)
elseif(TOILE_SANITIZE)
  message(FATAL_ERROR "TOILE_SANITIZE is `${TOILE_SANITIZE}`; expected `address`, `thread` or nothing")
endif()

# Sources of a module are compiled eight at a time: most of a source's time is that of the headers of others.  So what stands in an unnamed
# namespace has a name that no other source of its module gives to something else.
option(TOILE_UNITY "compile several sources of a module at once" OFF)
function(toile_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${TOILE_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()

find_program(TOILE_CCACHE ccache)
if(TOILE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${TOILE_CCACHE})
endif()
