# `libtoile`, static or shared (BUILD_SHARED_LIBS): all modules in one library behind the headers of include/toile, and its installation.
#
#   target            toile_library here, toile::toile for others, from find_package(toile) and from add_subdirectory alike
#   components        library (what a program needs to run), development (what it needs to be built), program
#
# The objects are those of the modules, compiled once with the flags of toile_rules, whichever kind is made.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(objects GLOBAL PROPERTY toile_objects)
add_library(toile_library ${objects})
add_library(toile::toile ALIAS toile_library)
set_target_properties(toile_library PROPERTIES
  OUTPUT_NAME toile EXPORT_NAME toile LINKER_LANGUAGE CXX
  ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
  # Below 1.0 a minor version may change what is public.
  VERSION ${toile_VERSION} SOVERSION ${toile_VERSION_MAJOR}.${toile_VERSION_MINOR})
target_include_directories(toile_library INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(toile_library INTERFACE cxx_std_20)
target_link_libraries(toile_library PRIVATE ${toile_linked})
target_link_libraries(toile_library PRIVATE $<BUILD_INTERFACE:toile_rules>)
get_target_property(kind toile_library TYPE)
set(toile_is_shared FALSE)
if(kind STREQUAL "SHARED_LIBRARY")
  set(toile_is_shared TRUE)
  # Templates of the standard library and of Eigen would be exported too, and be exchanged for those of a program with other flags.
  set(exports ${PROJECT_SOURCE_DIR}/cmake/toile_exports.map)
  target_link_options(toile_library PRIVATE LINKER:--version-script=${exports} LINKER:--no-undefined)
  set_property(TARGET toile_library APPEND PROPERTY LINK_DEPENDS ${exports})
  # What is inside a shared library has found its libraries already.
  set(toile_packages)
endif()
string(TOLOWER ${kind} kind)
string(REPLACE "_" " " kind ${kind})
message(STATUS "Toile: libtoile ${toile_VERSION}: ${kind}")

if(NOT TOILE_INSTALL)
  return()
endif()
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/toile)
install(TARGETS toile_library EXPORT toileTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/toile DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN *.hpp)
install(EXPORT toileTargets NAMESPACE toile:: DESTINATION ${config_dir} COMPONENT development)

set(toile_find_dependencies "")
foreach(package ${toile_packages})
  string(APPEND toile_find_dependencies "find_dependency(${package})\n")
endforeach()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/toileConfig.cmake.in ${PROJECT_BINARY_DIR}/toileConfig.cmake
  INSTALL_DESTINATION ${config_dir} NO_SET_AND_CHECK_MACRO)
set(fits SameMajorVersion)
if(toile_VERSION VERSION_LESS 1.0)
  set(fits SameMinorVersion)
endif()
write_basic_package_version_file(${PROJECT_BINARY_DIR}/toileConfigVersion.cmake VERSION ${toile_VERSION} COMPATIBILITY ${fits})
install(FILES ${PROJECT_BINARY_DIR}/toileConfig.cmake ${PROJECT_BINARY_DIR}/toileConfigVersion.cmake DESTINATION ${config_dir} COMPONENT development)

set(requires_private ${toile_pc_requires})
set(libs_private ${toile_pc_libs})
if(toile_is_shared)
  set(requires_private)
  set(libs_private)
endif()
list(JOIN requires_private ", " requires_private)
list(JOIN libs_private " " libs_private)
file(RELATIVE_PATH pc_to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${PROJECT_SOURCE_DIR}/cmake/toile.pc.in ${PROJECT_BINARY_DIR}/toile.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/toile.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
if(TARGET toile)
  install(TARGETS toile RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
