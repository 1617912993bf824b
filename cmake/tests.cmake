# One CTest program per tests/<kind>/test_*.c, labelled with its kind; scripts in tests/cli, tests/python and
# tests/checks. Only the kinds in SCREE_TEST_LABELS are built.
set(timeout_unit 120)
set(timeout_property 300)
set(timeout_physics 600)
set(timeout_regression 600)
set(timeout_single 300)
set(timeout_cuda_on_cpu 600)
set(timeout_device 600)
set(timeout_cli 600)
set(timeout_python 600)
set(timeout_checks 1800)
if(CMAKE_BUILD_TYPE MATCHES "Checked|Thread")
    set(timeout_unit 600) # sanitizers cost a factor of three to ten
    set(timeout_property 1200)
endif()

# Tests of threads set their number themselves; elsewhere one thread per test lets two tests run side by side.
set(test_environment "OMP_NUM_THREADS=1" "OMP_WAIT_POLICY=passive"
    "UBSAN_OPTIONS=print_stacktrace=1" "ASAN_OPTIONS=detect_stack_use_after_return=1:allocator_may_return_null=1"
    "LSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/checks/leaks.txt:print_suppressions=0"
    "SCREE_SOURCE_DIR=${CMAKE_SOURCE_DIR}")
if(CMAKE_BUILD_TYPE STREQUAL "Thread")
    list(REMOVE_ITEM test_environment "OMP_NUM_THREADS=1")
    list(APPEND test_environment "OMP_NUM_THREADS=4" "OMP_TOOL_LIBRARIES=libarcher.so"
        "TSAN_OPTIONS=ignore_noninstrumented_modules=1 halt_on_error=1")
endif()

function(scree_describe_test name kind)
    set_tests_properties(${name} PROPERTIES
        LABELS ${kind} TIMEOUT ${timeout_${kind}} SKIP_RETURN_CODE 77 ENVIRONMENT "${test_environment}"
        WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
endfunction()

# What several test programs share: tests/<kind>/*.c that are not tests themselves.
file(GLOB support_sources CONFIGURE_DEPENDS tests/*/*.c)
list(FILTER support_sources EXCLUDE REGEX "/test_[^/]*$|/cuda_on_cpu/|/reference/")
if(support_sources)
    add_library(scree_test_support STATIC EXCLUDE_FROM_ALL ${support_sources})
    target_include_directories(scree_test_support PRIVATE src tests)
    target_link_libraries(scree_test_support PUBLIC scree)
endif()

function(scree_add_test_programs kind library)
    if(NOT kind IN_LIST SCREE_TEST_LABELS)
        return()
    endif()
    file(GLOB sources CONFIGURE_DEPENDS tests/${kind}/test_*.c)
    foreach(source ${sources})
        get_filename_component(name ${source} NAME_WE)
        add_executable(${name} ${source})
        target_include_directories(${name} PRIVATE src tests)
        target_compile_definitions(${name} PRIVATE _XOPEN_SOURCE=700) # M_PI, POSIX
        if(TARGET scree_test_support AND library STREQUAL "scree")
            target_link_libraries(${name} PRIVATE scree_test_support)
        endif()
        target_link_libraries(${name} PRIVATE ${library} scree_dependencies)
        set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
        add_test(NAME ${name} COMMAND ${name})
        scree_describe_test(${name} ${kind})
        if(kind STREQUAL "regression" AND SCREE_COMPARE_WITH)
            add_test(NAME same_hash_${name} COMMAND ${CMAKE_SOURCE_DIR}/tests/checks/same_hashes.sh
                $<TARGET_FILE:${name}> ${SCREE_COMPARE_WITH}/tests/${name})
            scree_describe_test(same_hash_${name} ${kind})
        endif()
    endforeach()
endfunction()

# Programs behind the pages in validation/, built by their run.py.
file(GLOB study_sources CONFIGURE_DEPENDS validation/*/*.c)
foreach(source ${study_sources})
    get_filename_component(name ${source} NAME_WE)
    add_executable(${name} EXCLUDE_FROM_ALL ${source})
    target_include_directories(${name} PRIVATE src tests)
    target_compile_definitions(${name} PRIVATE _XOPEN_SOURCE=700) # M_PI
    target_link_libraries(${name} PRIVATE scree scree_dependencies)
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/studies)
endforeach()

foreach(kind unit property physics regression)
    scree_add_test_programs(${kind} scree)
endforeach()
scree_add_test_programs(single scree_single)

if("reference" IN_LIST SCREE_TEST_LABELS AND EXISTS ${CMAKE_SOURCE_DIR}/tests/reference/CMakeLists.txt)
    enable_language(CXX)
    add_subdirectory(tests/reference)
endif()
# The CUDA side: on a GPU if this build has CUDA, else emulated. Without a GPU the tests of the former are skipped.
if(SCREE_CUDA)
    function(scree_add_device_test program source library)
        add_executable(${program} tests/cuda_on_cpu/${source}.cu)
        target_include_directories(${program} PRIVATE src tests tests/cuda_on_cpu)
        target_compile_options(${program} PRIVATE $<$<COMPILE_LANGUAGE:CUDA>:${scree_cuda_options}>)
        target_link_libraries(${program} PRIVATE ${library} scree_dependencies)
        set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
        add_test(NAME ${program} COMMAND ${program})
        scree_describe_test(${program} device)
    endfunction()
    foreach(name test_features test_device test_overlap_teams test_kernels test_contact_kernels test_step test_laws)
        scree_add_device_test(${name}_on_gpu ${name} scree)
    endforeach()
    if(TARGET scree_single)
        scree_add_device_test(test_step_single_on_gpu test_step scree_single)
    endif()
elseif("cuda_on_cpu" IN_LIST SCREE_TEST_LABELS)
    enable_language(CXX)
    add_subdirectory(tests/cuda_on_cpu)
endif()

# Scripts find the program in SCREE_PROGRAM and are run by the interpreter of the virtual environment.
set(python ${CMAKE_SOURCE_DIR}/.venv/bin/python)
if(NOT EXISTS ${python})
    set(python python3)
endif()

function(scree_add_scripts kind)
    if(NOT kind IN_LIST SCREE_TEST_LABELS)
        return()
    endif()
    file(GLOB scripts CONFIGURE_DEPENDS tests/${kind}/test_*.py tests/${kind}/test_*.sh)
    foreach(script ${scripts})
        get_filename_component(base ${script} NAME_WE)
        set(name ${kind}_${base})
        if(script MATCHES "\\.py$")
            # pytest empties this folder at its start
            add_test(NAME ${name} COMMAND ${python} -B -m pytest -q -p no:cacheprovider
                --basetemp=${CMAKE_BINARY_DIR}/scratch/${name} ${script})
        else()
            add_test(NAME ${name} COMMAND bash ${script})
        endif()
        scree_describe_test(${name} ${kind})
        set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT
            "SCREE_PROGRAM=${CMAKE_BINARY_DIR}/scree" "SCREE_BUILD_DIR=${CMAKE_BINARY_DIR}" "SCREE_PYTHON=${python}")
    endforeach()
endfunction()
foreach(kind cli python checks)
    scree_add_scripts(${kind})
endforeach()

# the longest first, so that no core waits for them at the end
foreach(name checks_test_cuda checks_test_machine_code checks_test_headers)
    if(TEST ${name})
        set_tests_properties(${name} PROPERTIES COST 1000)
    endif()
endforeach()
