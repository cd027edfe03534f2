# The tests of the Python module.  One CTest test, `python`, runs pytest; `python_wheel_long` installs the package by pip in an empty environment.
if(TOILE_TESTS)
  enable_testing()  # here too: this folder may come before the line in the root
endif()

function(toile_python_tests_skipped why)
  if(TOILE_TESTS)
    add_test(NAME python COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${why}")
    set_tests_properties(python PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped: ")
  endif()
endfunction()

function(toile_python_tests)
  if(NOT TOILE_TESTS)
    return()
  endif()
  set(tests ${PROJECT_SOURCE_DIR}/python/tests)
  execute_process(COMMAND ${Python_EXECUTABLE} -c "import numpy, pytest" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
  if(missing)
    toile_python_tests_skipped("${Python_EXECUTABLE} has not both NumPy and pytest; tools/python_environment.sh ${CMAKE_BINARY_DIR} gets them from PyPI")
  else()
    # The same scene by C++, for its hash.
    add_executable(toile_python_twin ${tests}/twin.cpp)
    target_link_libraries(toile_python_twin PRIVATE toile_api)
    if(TARGET toile_rules)
      target_link_libraries(toile_python_twin PRIVATE toile_rules)
    endif()
    set(program "")
    if(TARGET toile)
      set(program $<TARGET_FILE:toile>)
    endif()
    add_test(NAME python COMMAND ${CMAKE_COMMAND} -E env
             PYTHONPATH=${CMAKE_CURRENT_BINARY_DIR} PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg
             TOILE_SOURCE_DIR=${PROJECT_SOURCE_DIR} TOILE_PROGRAM=${program} TOILE_TWIN=$<TARGET_FILE:toile_python_twin>
             ${Python_EXECUTABLE} -m pytest -q -p no:cacheprovider ${tests})
    set_tests_properties(python PROPERTIES TIMEOUT 600)
  endif()
  add_test(NAME python_wheel_long COMMAND ${Python_EXECUTABLE} ${tests}/wheel.py ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/python_wheel)
  set_tests_properties(python_wheel_long PROPERTIES TIMEOUT 3600 LABELS long SKIP_RETURN_CODE 77)
endfunction()
