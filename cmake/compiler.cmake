# Language, warnings and floating point, the same for every target that links scree_options.
set(CMAKE_C_STANDARD 17)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, Checked or Thread" FORCE)
endif()
# Asserts are SCREE_CHECKED's affair, so NDEBUG follows it. -O3 was measured: 1 to 5 % on overlaps, nothing on a run.
set(CMAKE_C_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_C_FLAGS_DEBUG "-O0 -g -DSCREE_CHECKED=1")
set(CMAKE_C_FLAGS_CHECKED
    "-O1 -g -DSCREE_CHECKED=1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer")
set(CMAKE_EXE_LINKER_FLAGS_CHECKED "-fsanitize=address,undefined")
set(CMAKE_C_FLAGS_THREAD "-O1 -g -DSCREE_CHECKED=1 -fsanitize=thread")
set(CMAKE_EXE_LINKER_FLAGS_THREAD "-fsanitize=thread")
set(CMAKE_CXX_FLAGS_RELEASE ${CMAKE_C_FLAGS_RELEASE})
set(CMAKE_CXX_FLAGS_DEBUG ${CMAKE_C_FLAGS_DEBUG})
set(CMAKE_CXX_FLAGS_CHECKED ${CMAKE_C_FLAGS_CHECKED})

# GCC 12.2 makes vfmsubadd of straight-line code whatever -ffp-contract says, if the processor has it.
set(may_have_fma ${SCREE_NATIVE})
if(NOT CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    set(may_have_fma ON)
endif()

find_package(OpenMP REQUIRED COMPONENTS C)

add_library(scree_options INTERFACE)
target_compile_options(scree_options INTERFACE
    $<$<COMPILE_LANGUAGE:C>:-Wall;-Wextra;-Werror>
    # a*b + c keeps its two roundings: the same bits from every compiler, processor and the CUDA kernels
    $<$<COMPILE_LANGUAGE:C,CXX>:-ffp-contract=off>
    $<$<AND:$<BOOL:${may_have_fma}>,$<C_COMPILER_ID:GNU>,$<COMPILE_LANGUAGE:C,CXX>>:-fno-tree-slp-vectorize>
    # nobody reads errno after sqrt() or the flags of the processor; values are not touched by this, unlike by fast-math
    $<$<COMPILE_LANGUAGE:C>:-fno-math-errno;-fno-trapping-math>
    $<$<AND:$<BOOL:${SCREE_NATIVE}>,$<COMPILE_LANGUAGE:C,CXX>>:-march=native>)
target_link_libraries(scree_options INTERFACE OpenMP::OpenMP_C m)
