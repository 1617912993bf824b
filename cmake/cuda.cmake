# The kernels for NVIDIA GPUs and the host side that launches them, compiled by nvcc into libscree_cuda, which libscree
# calls, and the same in single precision. tests/checks/test_cuda.sh uses the same flags.
enable_language(CUDA)
set(CMAKE_CUDA_STANDARD 17)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
# machine code for 8.x, 9.x and 12.x; what the driver compiles at the first run for 10.x, 11.x and all that are newer
if(CMAKE_CUDA_ARCHITECTURES STREQUAL "" OR CMAKE_CUDA_ARCHITECTURES STREQUAL CMAKE_CUDA_ARCHITECTURES_DEFAULT)
    set(CMAKE_CUDA_ARCHITECTURES "80-real;90;120")
endif()
find_package(CUDAToolkit REQUIRED)
# no contraction, denormals kept, division and square root rounded correctly: the bits of the CPU
set(scree_cuda_options
    --fmad=false --ftz=false --prec-div=true --prec-sqrt=true -Werror=all-warnings -Xcompiler=-ffp-contract=off)
# scree_add_cuda(NAME LIBRARY): the kernels in the precision of the library, which is made to call them
function(scree_add_cuda name library)
    add_library(${name} STATIC ${cuda_sources})
    target_include_directories(${name} PUBLIC include src)
    target_compile_options(${name} PRIVATE ${scree_cuda_options})
    target_link_libraries(${name} PUBLIC ${library} CUDA::cudart_static)
    target_compile_definitions(${library} PUBLIC SCREE_CUDA=1)
    target_link_libraries(${library} PUBLIC ${name})
endfunction()
