# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause

# Flags every target of ours shares. -ffp-contract=off: a fused multiply-add would change stored numbers from one
# machine to the next.
function(opponens_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
    $<$<BOOL:${OPPONENS_WERROR}>:-Werror>)
endfunction()

# opponens_module(name HEADERS ... SOURCES ... PUBLIC ... PRIVATE ...): target opponens::name, installed and exported.
function(opponens_module name)
  cmake_parse_arguments(ARG "" "" "HEADERS;SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target opponens_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(opponens::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON
    POSITION_INDEPENDENT_CODE ON)
  opponens_compile_options(${target})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  install(TARGETS ${target} EXPORT opponens
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/opponens
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# opponens_wide_source(target name): NAME.cpp, which decides only what double precision looks at again, and so may fuse
# multiplications; and NAME_avx2.cpp beside it where the processor may have AVX2 (the target then has OPPONENS_AVX2).
# Files of their own keep the wider instructions out of everything else.
function(opponens_wide_source target name)
  set_source_files_properties(${name}.cpp ${name}_avx2.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set_property(SOURCE ${name}.cpp ${name}_avx2.cpp APPEND PROPERTY COMPILE_OPTIONS
    -ffp-contract=fast -fno-math-errno -fno-signed-zeros -fno-trapping-math -ffinite-math-only -Wno-psabi)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_sources(${target} PRIVATE ${name}_avx2.cpp)
    set_property(SOURCE ${name}_avx2.cpp APPEND PROPERTY COMPILE_OPTIONS -mavx2 -mfma)
    target_compile_definitions(${target} PRIVATE OPPONENS_AVX2)
  endif()
endfunction()
