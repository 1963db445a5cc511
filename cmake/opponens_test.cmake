# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause

# The system's Python, which has Debian's h5py; another one in PATH may not.
set(OPPONENS_PYTHON /usr/bin/python3)

# opponens_test(name LABEL label [LONG patterns...] SOURCES ... LIBRARIES ...): one GoogleTest executable; each case is a
# ctest test. Without OPPONENS_LONG_TESTS the cases that match a pattern of LONG are left out, and the others run together
# in a few processes: of a sanitized one the start and the end, and what a suite makes once, are most of the time.
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
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE
    OPPONENS_SOURCE_DIR="${PROJECT_SOURCE_DIR}" OPPONENS_SHARED_DATA="${OPPONENS_SHARED_DATA}")
  if(NOT OPPONENS_LONG_TESTS)
    list(JOIN ARG_LONG ":" long)
    foreach(part RANGE 3)
      add_test(NAME ${name}/part_${part} COMMAND ${name} --gtest_brief=1 "--gtest_filter=-${long}")
      set_tests_properties(${name}/part_${part} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT 900
        ENVIRONMENT "GTEST_TOTAL_SHARDS=4;GTEST_SHARD_INDEX=${part}")
    endforeach()
    return()
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_PREFIX "${name}/"
    PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT})
endfunction()
