# toile_module(name DEPENDS lower...  LIBRARIES third-party...)
#
# One static library per folder of src/.  Third-party libraries are private: no header of ours shows them,
# except Eigen, which is our vector type inside src/.  The tests and the program are linked with modules; `libtoile`, which is installed, is made
# of the same objects (cmake/toile_library.cmake).
function(toile_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  set(visibility PUBLIC)
  if(sources)
    add_library(toile_${name} STATIC ${sources})
    set_property(GLOBAL APPEND PROPERTY toile_objects $<TARGET_OBJECTS:toile_${name}>)
    target_link_libraries(toile_${name} PRIVATE ${ARG_LIBRARIES})
    toile_unity(toile_${name})
  else()  # headers only
    add_library(toile_${name} INTERFACE)
    set(visibility INTERFACE)
  endif()
  target_include_directories(toile_${name} ${visibility} ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(toile_${name} ${visibility} toile_rules Eigen3::Eigen)
  foreach(lower ${ARG_DEPENDS})
    target_link_libraries(toile_${name} ${visibility} toile_${lower})
  endforeach()
endfunction()
