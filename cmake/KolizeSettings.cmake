# Flags and folders that every target shares.
option(KOLIZE_TESTS "Build the tests" ON)
option(KOLIZE_BENCH "Build the benchmarks against other libraries (Bullet, Embree, FCL, ODE)" OFF)
option(KOLIZE_FUZZ "Build the fuzzer of the mesh readers (clang only)" OFF)
set(KOLIZE_SANITIZE "" CACHE STRING "Sanitizers, comma separated: address,undefined or thread")

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# One layout for build tree and installation: bin/kolize finds ../lib and ../lib/kolize (the plugins).
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(KOLIZE_PLUGIN_DIRECTORY ${CMAKE_BINARY_DIR}/lib/kolize)

# No contraction: the same bits with and without FMA, at every optimisation level.
add_compile_options(-Wall -Wextra -ffp-contract=off)
if(KOLIZE_SANITIZE)
  add_compile_options(-fsanitize=${KOLIZE_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${KOLIZE_SANITIZE})
endif()

# Boost.DLL with std::filesystem: no compiled Boost library is needed.
add_compile_definitions(BOOST_DLL_USE_STD_FS)
