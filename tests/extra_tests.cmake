# Tests that are not GoogleTest executables. Included by tests/CMakeLists.txt.
set(STERNA_SYSTEM_PYTHON /usr/bin/python3)  # Debian's python3, because another python3 on PATH lacks meshio and VTK. ./run requires no Python

# Every GoogleTest executable writes its results for tools/count_skips.
foreach(folder ${test_folders})
  file(RELATIVE_PATH name ${CMAKE_CURRENT_SOURCE_DIR} ${folder})
  string(REPLACE "/" "_" name test_${name})
  set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT GTEST_OUTPUT=json:${CMAKE_BINARY_DIR}/test_results/${name}.json)
endforeach()

# The style checks, and tests that each check finds a deliberate violation of each rule.
add_test(NAME architecture COMMAND ${CMAKE_SOURCE_DIR}/tools/check_architecture --root ${CMAKE_SOURCE_DIR} --binary $<TARGET_FILE:sterna>)
add_test(NAME architecture_self_test
         COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/check_architecture_test.py ${CMAKE_SOURCE_DIR}/tools/check_architecture ${CMAKE_CXX_COMPILER})
add_test(NAME references COMMAND ${CMAKE_SOURCE_DIR}/tools/check_references --root ${CMAKE_SOURCE_DIR})
add_test(NAME references_self_test
         COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/check_references_test.py ${CMAKE_SOURCE_DIR}/tools/check_references)
add_test(NAME prose COMMAND ${CMAKE_SOURCE_DIR}/tools/check_prose --root ${CMAKE_SOURCE_DIR})
add_test(NAME prose_self_test COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/check_prose_test.py ${CMAKE_SOURCE_DIR}/tools/check_prose)
add_test(NAME count_skips_self_test COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/count_skips_test.py ${CMAKE_SOURCE_DIR}/tools/count_skips)
add_test(NAME bench_self_test COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/bench_test.py ${CMAKE_SOURCE_DIR}/tools/bench)

# ThreadSanitizer finds a deliberate race in parallel loops of sterna, and none in correct loops. The test uses the threads of the preset tsan, and runs in every preset.
if(STERNA_SANITIZE STREQUAL "" OR STERNA_SANITIZE STREQUAL "thread")
  file(GLOB tsan_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/geom/base/parallel.cpp ${CMAKE_SOURCE_DIR}/geom/base/run_context.cpp ${CMAKE_SOURCE_DIR}/geom/base/error.cpp)
  add_executable(sterna_tsan_counter tsan/counter.cpp ${tsan_sources})
  target_include_directories(sterna_tsan_counter PRIVATE ${CMAKE_SOURCE_DIR})
  target_compile_definitions(sterna_tsan_counter PRIVATE STERNA_STD_THREADS)
  # -O1, because -O3 merges the racing increments of a chunk.
  target_compile_options(sterna_tsan_counter PRIVATE -fsanitize=thread -g -O1 -fno-omit-frame-pointer)
  target_link_options(sterna_tsan_counter PRIVATE -fsanitize=thread)
  target_link_libraries(sterna_tsan_counter PRIVATE Threads::Threads)
  foreach(mode race clean)
    add_test(NAME tsan_${mode} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tsan/run_counter $<TARGET_FILE:sterna_tsan_counter> ${mode})
  endforeach()
endif()

# Other programs accept meshes of sterna, and tools/accept_mesh rejects bad meshes.
add_test(NAME accept_mesh COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/accept_mesh_test.py ${CMAKE_SOURCE_DIR}/tools/accept_mesh $<TARGET_FILE:sterna>
         ${CMAKE_CURRENT_SOURCE_DIR}/data/scripts/box.stl)
set_tests_properties(accept_mesh PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)

# The installed programs and files work in the installation folder.
add_test(NAME install COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/install_test.py ${CMAKE_BINARY_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/data/scripts/box.stl)
set_tests_properties(install PROPERTIES TIMEOUT 300)

# A program of another project uses the installed libraries (docs/library.md).
add_test(NAME library COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/library_test.py ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/data/scripts/box.stl)
set_tests_properties(library PROPERTIES TIMEOUT 300)

# The Python interface.
add_test(NAME python COMMAND ${STERNA_SYSTEM_PYTHON} -W error ${CMAKE_CURRENT_SOURCE_DIR}/scripting/python/sterna_test.py ${CMAKE_SOURCE_DIR} $<TARGET_FILE:sterna> ${STERNA_TEST_DATA})
set_tests_properties(python PROPERTIES TIMEOUT 300)

# Links and pictures of the documents exist, and the index lists every page.
add_test(NAME documents COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/documents_test.py ${CMAKE_SOURCE_DIR} $<TARGET_FILE:sterna>)

# Instructions in documents work: the test writes their files, runs their commands and finds their output.
foreach(document python half_models tutorials/tunnel_series tutorials/aircraft_from_numbers tutorials/one_off_cad gallery)
  get_filename_component(name ${document} NAME)
  add_test(NAME document_${name}
           COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/run_document.py ${CMAKE_SOURCE_DIR}/docs/${document}.md ${CMAKE_SOURCE_DIR} $<TARGET_FILE:sterna> ${CMAKE_BINARY_DIR}/scratch/document_${name})
  set_tests_properties(document_${name} PROPERTIES TIMEOUT 600 COST 100)
endforeach()

# OpenFOAM solvers reproduce known flows on meshes of sterna (docs/verification.md): a flat plate, the potential flow around a sphere.
add_test(NAME verify_flow COMMAND ${CMAKE_SOURCE_DIR}/tools/verify_flow --short --sterna $<TARGET_FILE:sterna> --folder ${CMAKE_BINARY_DIR}/scratch/verify_flow)
set_tests_properties(verify_flow PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900 COST 100)
# Two aircraft cases of foam_case stay bounded. All twelve complete runs: tools/verify_flow aircraft.
add_test(NAME verify_aircraft COMMAND ${CMAKE_SOURCE_DIR}/tools/verify_flow aircraft --short --data ${STERNA_TEST_DATA} --sterna $<TARGET_FILE:sterna> --folder ${CMAKE_BINARY_DIR}/scratch/verify_aircraft)
set_tests_properties(verify_aircraft PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1200 COST 200)
# The comparison of gate limits with solver runs (docs/measurements/gates.md), on a small wing, sound and damaged. The complete experiment: tools/verify_gates.
add_test(NAME verify_gates COMMAND ${CMAKE_SOURCE_DIR}/tools/verify_gates --short --sterna $<TARGET_FILE:sterna> --folder ${CMAKE_BINARY_DIR}/scratch/verify_gates)
set_tests_properties(verify_gates PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900 COST 50)

# A browser without network uses every control of the report pages.
add_test(NAME report_page_browser COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripting/report/run_browser_test ${CMAKE_BINARY_DIR} fixtures)
set_tests_properties(report_page_browser PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1200)

add_test(NAME report_real_pages COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripting/report/browse_real_pages ${CMAKE_BINARY_DIR} ${STERNA_TEST_DATA})
add_custom_target(report_pages COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripting/report/browse_real_pages ${CMAKE_BINARY_DIR} ${STERNA_TEST_DATA} --all USES_TERMINAL)  # all five pages, started manually
set_tests_properties(report_real_pages PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1200 DEPENDS "script_11_surface_file;script_07_aircraft_to_mesh;script_08_wind_tunnel;script_09_half_model;report_page_browser")

# The same browser uses every control of the workbench.
add_test(NAME view_browser COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripting/view/run_view_test ${CMAKE_BINARY_DIR} ${STERNA_TEST_DATA})
set_tests_properties(view_browser PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1200 COST 250 DEPENDS report_page_browser)

# The tests of scripting/ run the program. Each script of scripts/ is a separate test in a separate folder.
add_dependencies(test_scripting sterna)
add_dependencies(test_scripting_manual sterna)
add_dependencies(test_scripting_remesh sterna)
add_dependencies(test_io_volume sterna)
add_dependencies(test_scripting_series sterna)
add_dependencies(test_scripting_view sterna)
file(GLOB scripts CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/scripts/*.lua)
foreach(script ${scripts})
  get_filename_component(name ${script} NAME_WE)
  set(folder ${CMAKE_BINARY_DIR}/scratch/script_${name})
  file(MAKE_DIRECTORY ${folder})
  add_test(NAME script_${name} COMMAND sterna run ${script} WORKING_DIRECTORY ${folder})
  # The models of the scripts must not cause the warning that requires a finer mesh.
  set_tests_properties(script_${name} PROPERTIES TIMEOUT 300 FAIL_REGULAR_EXPRESSION "where the model is smooth")
endforeach()

add_test(NAME script_models COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/tools/script_models_test.py $<TARGET_FILE:sterna> ${CMAKE_SOURCE_DIR}/scripts)
set_tests_properties(script_models PROPERTIES TIMEOUT 300)

# The longest tests start first, so that ctest -j2 does not end with one of them alone: scripts whose meshes report_real_pages needs, then executables that make complete meshes.
foreach(name 11_surface_file 07_aircraft_to_mesh 08_wind_tunnel 09_half_model)
  set_tests_properties(script_${name} PROPERTIES COST 300)
endforeach()
set_tests_properties(report_page_browser PROPERTIES COST 250)
set_tests_properties(report_real_pages PROPERTIES COST 200)
set_tests_properties(test_volmesh_driver test_scripting_series test_scripting_gates test_scripting PROPERTIES COST 100)

# Benchmarks: tests/bench/NAME_main.cpp -> NAME, built by tools/build benches and started manually.
file(GLOB bench_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/bench/*_main.cpp)
foreach(source ${bench_sources})
  get_filename_component(name ${source} NAME_WE)
  string(REGEX REPLACE "_main$" "" name ${name})
  add_executable(${name} EXCLUDE_FROM_ALL ${source})
  target_link_libraries(${name} PRIVATE sterna_test_support)
  list(APPEND benches ${name})
endforeach()
add_custom_target(benches DEPENDS ${benches})
# Compares the spline evaluators of sterna with those of OpenCASCADE.
target_include_directories(spline_bench SYSTEM PRIVATE ${OpenCASCADE_INCLUDE_DIR})
target_link_libraries(spline_bench PRIVATE ${STERNA_OCCT})

# Random torn shapes: 5 of them in the tests, 200 with tools/build torn_long.
add_custom_target(torn_long COMMAND ${CMAKE_COMMAND} -E env STERNA_TORN=200 $<TARGET_FILE:test_surfmesh_wrap> --gtest_filter=WrapTorn.Shapes* USES_TERMINAL)
# Other remeshers for comparison: CGAL and Gmsh.
target_link_libraries(remesh_peers PRIVATE CGAL::CGAL gmsh gmp mpfr)

# Random cases (docs/soak.md): the judge distinguishes good from bad results, and ten cases are not wrong. The audit program shares no code with sterna.
add_executable(soak_mesh_audit soak/mesh_audit_main.cpp)
set(sanitized_soak)
set(sanitized_faults)
if(STERNA_SANITIZE)
  set(sanitized_soak --no-memory-limit --time-limit 2400)
  set(sanitized_faults --without little_memory crash)
endif()
if(NOT STERNA_SANITIZE)  # the test uses memory limits, which sanitizers exceed
  add_test(NAME soak_self_test COMMAND ${STERNA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/soak/soak_test.py $<TARGET_FILE:sterna> $<TARGET_FILE:soak_mesh_audit> ${CMAKE_BINARY_DIR}/scratch/soak_self_test)
  set_tests_properties(soak_self_test PROPERTIES TIMEOUT 900 COST 100)
endif()
add_test(NAME soak COMMAND ${CMAKE_SOURCE_DIR}/tools/soak --cases 10 --seed 1 --jobs 2 ${sanitized_soak} --data none --sterna $<TARGET_FILE:sterna> --audit $<TARGET_FILE:soak_mesh_audit> --keep ${CMAKE_BINARY_DIR}/scratch/soak)
file(GLOB soak_cases CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/data/soak/*.json)
add_test(NAME soak_again COMMAND ${CMAKE_SOURCE_DIR}/tools/soak --again ${soak_cases} --no-reduce ${sanitized_soak} --data none --sterna $<TARGET_FILE:sterna> --audit $<TARGET_FILE:soak_mesh_audit> --keep ${CMAKE_BINARY_DIR}/scratch/soak_again)
set_tests_properties(soak soak_again PROPERTIES TIMEOUT 900 COST 100)

# Machine faults (docs/soak.md): full disks, kills, little memory, damaged files, two runs at the same time.
add_executable(with_slurm faults/with_slurm_main.cpp scripting/series/slurm_cluster.cpp)
target_link_libraries(with_slurm PRIVATE sterna_test_support)
add_test(NAME faults COMMAND ${CMAKE_SOURCE_DIR}/tools/faults --short ${sanitized_faults} --sterna $<TARGET_FILE:sterna> --with-slurm $<TARGET_FILE:with_slurm> --folder ${CMAKE_BINARY_DIR}/scratch/faults)
set_tests_properties(faults PROPERTIES TIMEOUT 900 COST 100)

if(STERNA_SANITIZE)  # sanitized programs take ten times as long
  get_property(all_tests DIRECTORY PROPERTY TESTS)
  set_tests_properties(${all_tests} PROPERTIES TIMEOUT ${test_seconds})
endif()
