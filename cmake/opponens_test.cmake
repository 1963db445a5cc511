# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause

# The system's Python, which has Debian's h5py; another one in PATH may not.
set(OPPONENS_PYTHON /usr/bin/python3)

# opponens_test(name LABEL label [LONG patterns...] SOURCES ... LIBRARIES ...): one GoogleTest executable; each case is a
# ctest test, or all of it is one without OPPONENS_TEST_CASES. Without OPPONENS_LONG_TESTS the cases that match a pattern
# of LONG are left out.
function(opponens_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "LONG;SOURCES;LIBRARIES" ${ARGN})
  if(NOT OPPONENS_LONG_TESTS AND ARG_LABEL MATCHES "release_only|statistical")
    return()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  opponens_compile_options(${name})
  # What is tested, the libraries, keeps its own optimisation.
  separate_arguments(options UNIX_COMMAND "${OPPONENS_TEST_OPTIONS}")
  target_compile_options(${name} PRIVATE ${options})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE
    OPPONENS_SOURCE_DIR="${PROJECT_SOURCE_DIR}" OPPONENS_SHARED_DATA="${OPPONENS_SHARED_DATA}")
  set(filter "*")
  if(ARG_LONG AND NOT OPPONENS_LONG_TESTS)
    list(JOIN ARG_LONG ":" long)
    set(filter "-${long}")
  endif()
  if(OPPONENS_TEST_CASES)
    gtest_discover_tests(${name} TEST_FILTER "${filter}" DISCOVERY_TIMEOUT 60 TEST_PREFIX "${name}/"
      PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT})
  else()
    add_test(NAME ${name} COMMAND ${name} "--gtest_filter=${filter}" --gtest_brief=1)
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT 1200)
  endif()
endfunction()
