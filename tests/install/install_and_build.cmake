# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
# Installs BUILD into WORK/prefix, then configures, builds and runs CONSUMER against it.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "exit ${code}: ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
# The installed program takes its models from beside itself, not from the source tree, where the same names lie: the copy
# there is changed, and what was simulated must name the changed copy's hash.
set(model models/human/grasp_types.yaml)
if(NOT EXISTS ${WORK}/prefix/share/opponens/${model})
  message(FATAL_ERROR "${model} was not installed")
endif()
file(APPEND ${WORK}/prefix/share/opponens/${model} "\n# changed by the test\n")
file(SHA256 ${WORK}/prefix/share/opponens/${model} changed)
function(opponens output)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=OPPONENS_DATA ${WORK}/prefix/bin/opponens ${ARGN} --json
    WORKING_DIRECTORY ${WORK} OUTPUT_VARIABLE text RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "exit ${code}: opponens ${ARGN}")
  endif()
  set(${output} "${text}" PARENT_SCOPE)
endfunction()
opponens(made simulate --store ${WORK}/store --repetitions 2)
string(JSON id GET "${made}" ids 0)
opponens(shown show ${id} --store ${WORK}/store)
string(JSON recorded GET "${shown}" object provenance files ${model})
if(NOT recorded STREQUAL changed)
  message(FATAL_ERROR "the installed program used another ${model}: ${recorded}, expected ${changed}")
endif()
