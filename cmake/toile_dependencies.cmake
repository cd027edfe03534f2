# The libraries of others.  `toile_linked`: those that a program has to be linked with beside libtoile.a; `toile_packages`: where toileConfig.cmake
# finds them, `toile_pc_requires` and `toile_pc_libs`: where toile.pc does.  Eigen and nlohmann_json are headers, and no public header shows
# them: who uses Toile needs neither.

# Needed by the core.
find_package(Eigen3 3.4 REQUIRED)          # vectors, everywhere
find_package(TBB REQUIRED)                 # threads: src/core
find_package(hwy 1.0.3 REQUIRED)           # instruction sets: material, assembly, solver
find_package(fmt REQUIRED)                 # numbers as text, the same in every locale
find_package(nlohmann_json REQUIRED)       # patterns, scenes and reports are JSON
find_package(yaml-cpp REQUIRED)            # the measurements that come with a body are YAML
set(toile_yaml yaml-cpp)                   # its target's name until 0.7
if(TARGET yaml-cpp::yaml-cpp)
  set(toile_yaml yaml-cpp::yaml-cpp)
endif()
set(toile_linked TBB::tbb fmt::fmt hwy::hwy ${toile_yaml})
set(toile_packages TBB fmt hwy yaml-cpp)
set(toile_pc_requires tbb fmt libhwy yaml-cpp)
set(toile_pc_libs -lstdc++)

# The program.
if(TOILE_CLI AND (PROJECT_IS_TOP_LEVEL OR NOT TOILE_CLI STREQUAL "AUTO"))
  find_package(CLI11 QUIET)
endif()
toile_part(CLI "the program `toile`" NEEDS "CLI11 (Debian: libcli11-dev)" FOUND CLI11_FOUND WANTED ${PROJECT_IS_TOP_LEVEL})
if(TOILE_SQLITE AND toile_has_CLI)
  find_package(SQLite3 QUIET)
endif()
toile_part(SQLITE "the index of batches" NEEDS "SQLite 3 (Debian: libsqlite3-dev)" FOUND SQLite3_FOUND WANTED ${toile_has_CLI})

# Pictures.  Embree 4, or 3: src/preview/embree.hpp has what differs.
if(TOILE_PREVIEW)
  find_package(embree 4 QUIET)
  if(NOT embree_FOUND)
    find_package(embree 3 QUIET)
  endif()
  find_package(PNG QUIET)
endif()
toile_part(PREVIEW "pictures" NEEDS "Embree 3 or 4 and libpng (Debian: libembree-dev, libpng-dev)" FOUND embree_FOUND PNG_FOUND WANTED TRUE)
if(toile_has_PREVIEW)
  string(REGEX MATCH "^[0-9]+" toile_embree_major "${embree_VERSION}")
  set(toile_picture_libraries embree PNG::PNG)
  list(APPEND toile_linked ${toile_picture_libraries})
  list(APPEND toile_packages "embree ${toile_embree_major}" PNG)
  list(APPEND toile_pc_requires libpng)
  list(APPEND toile_pc_libs -lembree${toile_embree_major})
endif()

# glTF files.  Debian's package has a library too, which brings readers of images with it: its header alone is used (src/io/gltf_library.hpp).
if(TOILE_GLTF)
  find_package(TinyGLTF QUIET)
  find_path(toile_tiny_gltf tiny_gltf.h)
  mark_as_advanced(toile_tiny_gltf)
endif()
toile_part(GLTF "glTF files" NEEDS "tinygltf (Debian: libtinygltf-dev)" FOUND TinyGLTF_FOUND toile_tiny_gltf WANTED TRUE)

# What is for those who work on Toile.
if(TOILE_TESTS AND (PROJECT_IS_TOP_LEVEL OR NOT TOILE_TESTS STREQUAL "AUTO"))
  find_package(GTest QUIET)
endif()
toile_part(TESTS "tests" NEEDS "GoogleTest (Debian: libgtest-dev)" FOUND GTest_FOUND WANTED ${PROJECT_IS_TOP_LEVEL})
if(TOILE_BENCH AND (PROJECT_IS_TOP_LEVEL OR NOT TOILE_BENCH STREQUAL "AUTO"))
  find_package(benchmark QUIET)
endif()
toile_part(BENCH "benchmarks of the pieces" NEEDS "google-benchmark (Debian: libbenchmark-dev)" FOUND benchmark_FOUND WANTED ${PROJECT_IS_TOP_LEVEL})
