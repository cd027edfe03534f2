# Rules that hold for every target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

# Same source, same bits: no contraction of a*b+c, no reassociation.  (docs/conventions.md#determinism)
add_compile_options(-ffp-contract=off -fno-fast-math)
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Werror)
add_compile_options(-fvisibility=hidden)
add_compile_definitions(EIGEN_MPL2_ONLY EIGEN_DONT_PARALLELIZE)
# Eigen leaves vectors unfilled, resize() too.  With assertions they hold NaN until something is written, so that what reads them is seen.
add_compile_definitions($<$<CONFIG:Debug>:EIGEN_INITIALIZE_MATRICES_BY_NAN>)

set(TOILE_SANITIZE "" CACHE STRING "`address` (with undefined behaviour) or `thread`; empty: none")
if(TOILE_SANITIZE STREQUAL "address")
  add_compile_options(-fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_compile_definitions(_GLIBCXX_ASSERTIONS)  # an index beyond a span or vector, wherever its memory ends
  add_link_options(-fsanitize=address,undefined)
elseif(TOILE_SANITIZE STREQUAL "thread")
  add_compile_options(-fsanitize=thread -fno-omit-frame-pointer)
  add_compile_definitions(TOILE_THREAD_SANITIZER)
  add_link_options(-fsanitize=thread)
elseif(TOILE_SANITIZE)
  message(FATAL_ERROR "TOILE_SANITIZE is `${TOILE_SANITIZE}`; expected `address`, `thread` or nothing")
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
