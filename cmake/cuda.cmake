# The kernels for NVIDIA GPUs and the host side that launches them, compiled by nvcc into libscree_cuda, which libscree
# calls. tests/checks/test_cuda.sh uses the same flags.
enable_language(CUDA)
set(CMAKE_CUDA_STANDARD 17)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
if(CMAKE_CUDA_ARCHITECTURES STREQUAL "" OR CMAKE_CUDA_ARCHITECTURES STREQUAL CMAKE_CUDA_ARCHITECTURES_DEFAULT)
    set(CMAKE_CUDA_ARCHITECTURES "80-real;90-real;120")
endif()
add_library(scree_cuda STATIC ${cuda_sources})
target_include_directories(scree_cuda PUBLIC include src)
# no contraction, denormals kept, division and square root rounded correctly: the bits of the CPU
target_compile_options(scree_cuda PRIVATE
    --fmad=false --ftz=false --prec-div=true --prec-sqrt=true -Werror=all-warnings -Xcompiler=-ffp-contract=off)
find_package(CUDAToolkit REQUIRED)
target_link_libraries(scree_cuda PUBLIC scree CUDA::cudart_static)
target_compile_definitions(scree PUBLIC SCREE_CUDA=1)
target_link_libraries(scree PUBLIC scree_cuda)
