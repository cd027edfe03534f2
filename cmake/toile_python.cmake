# Which Python, and its nanobind: of build/.../python_env, where tools/python_environment.sh has made it, or of the system.  pip names its own.
if(NOT SKBUILD AND NOT DEFINED Python_EXECUTABLE AND EXISTS ${PROJECT_BINARY_DIR}/python_env/bin/python)
  set(Python_EXECUTABLE ${PROJECT_BINARY_DIR}/python_env/bin/python)
endif()
# For the stable ABI CMake has to be 3.26; pip, which tags the wheel by it, says that it is required.
set(stable_abi OPTIONAL_COMPONENTS Development.SABIModule)
if(SKBUILD_SABI_COMPONENT)
  set(stable_abi ${SKBUILD_SABI_COMPONENT})
endif()
find_package(Python 3.10 COMPONENTS Interpreter Development.Module ${stable_abi})
if(Python_FOUND)
  execute_process(COMMAND ${Python_EXECUTABLE} -m nanobind --cmake_dir
                  OUTPUT_VARIABLE nanobind_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  find_package(nanobind CONFIG QUIET)
endif()
