# Language, warnings, and the flags that make results equal bit by bit in all builds.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo" FORCE)
endif()

# The option for code whose speed does not matter, such as code for command lines and JSON. Such
# code takes long to compile. GCC needs a quarter less time with -Og than with -O1.
set(FOGLINE_COLD_CODE $<$<CONFIG:Release>:-Og>)
# The option for code that mostly waits for the network or the disk.
set(FOGLINE_IO_CODE $<$<CONFIG:Release>:-O2>)

# If this option is ON, several source files are compiled as one, because the headers take most of
# the compiler's time. If it is OFF, only a changed file is compiled again.
option(FOGLINE_UNITY "Compile several source files at once" ON)
# This option is for tools/mutate, which changes one file of a library at a time. So it is faster to
# compile the files of a library one by one. The files of a test are still compiled as one, because
# tools/mutate changes none of them.
option(FOGLINE_UNITY_TESTS_ONLY "Compile only tests in this way" OFF)
set(CMAKE_UNITY_BUILD ${FOGLINE_UNITY})
if(FOGLINE_UNITY_TESTS_ONLY)
  set(CMAKE_UNITY_BUILD OFF)
endif()
set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)

# GCC starts its garbage collection only when it has allocated this much memory, in KiB. With a
# value as large as this one, GCC needs a tenth less time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(--param=ggc-min-heapsize=1000000)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

# Debug, release and -march=native builds give the same results. The compiler uses no fused
# multiply-add, because a fused multiply-add rounds once instead of twice. Eigen does not vectorise,
# because vector code adds in another order.
add_compile_options(-ffp-contract=off)
add_compile_definitions(EIGEN_DONT_VECTORIZE)
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-missing-field-initializers)

# By default, a warning is an error only with Debian 12's compiler, the compiler that the developers
# use. Other compilers have other warnings.
set(werror_default OFF)
if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND
   CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12 AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  set(werror_default ON)
endif()
option(FOGLINE_WERROR "Treat warnings as errors" ${werror_default})
if(FOGLINE_WERROR)
  add_compile_options(-Werror)
endif()

# With this option, the compiler adds counters for the executed lines. The counters are atomic, so
# the counts are right even if several threads run a line. Functions are not inlined, because an
# inlined function has no lines of its own.
option(FOGLINE_COVERAGE "Count the lines that are executed (tools/test --coverage)" OFF)
if(FOGLINE_COVERAGE)
  add_compile_options(--coverage -fprofile-update=atomic -fno-inline)
  add_link_options(--coverage)
endif()

set(FOGLINE_SANITIZE "" CACHE STRING "Sanitizers for everything, such as address,undefined")
if(FOGLINE_SANITIZE)
  add_compile_options(-fsanitize=${FOGLINE_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${FOGLINE_SANITIZE})
endif()

# Release programs have no symbols, because symbols would make the build folder 30 MB larger.
# Programs of other build types keep their symbols. Programs with sanitizers keep them, too, because
# the reports of sanitizers name functions.
set(FOGLINE_STRIP $<$<CONFIG:Release>:-s>)
if(NOT FOGLINE_SANITIZE)
  add_link_options(${FOGLINE_STRIP})
endif()
