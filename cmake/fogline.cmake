# fogline_add_library(NAME [SUBFOLDER...]): builds *.cc of this folder and of these subfolders as
# the static library fogline_NAME. The caller adds the libraries that this library links.
function(fogline_add_library name)
  # CMake finds the properties of a source file only if its path is spelled the same everywhere. So
  # the loop takes CMAKE_CURRENT_SOURCE_DIR itself: with a subfolder ".", paths would contain "/./".
  list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE subfolders)
  set(sources)
  set(folders)
  foreach(folder IN LISTS CMAKE_CURRENT_SOURCE_DIR subfolders)
    file(GLOB files CONFIGURE_DEPENDS "${folder}/*.cc")
    list(FILTER files EXCLUDE REGEX "_main\\.cc$")
    list(APPEND sources ${files})
    if(files)
      file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${folder}")
      list(APPEND folders "${folder}")
    endif()
  endforeach()
  add_library(fogline_${name} STATIC ${sources})
  target_include_directories(fogline_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  set_property(TARGET fogline_${name} PROPERTY FOGLINE_FOLDERS ${folders})
  set_property(GLOBAL APPEND PROPERTY FOGLINE_LIBRARIES fogline_${name})
endfunction()

# fogline_write_links(FILE): writes one line "LIBRARY FOLDER,FOLDER... LINKED..." for each library
# of fogline_add_library(). LIBRARY is the name of the library, FOLDER a folder of its sources, and
# LINKED a library of Fogline that LIBRARY links.
function(fogline_write_links file)
  get_property(libraries GLOBAL PROPERTY FOGLINE_LIBRARIES)
  set(lines)
  foreach(library IN LISTS libraries)
    get_target_property(folders ${library} FOGLINE_FOLDERS)
    list(JOIN folders "," folders)
    get_target_property(own ${library} LINK_LIBRARIES)
    get_target_property(passed_on ${library} INTERFACE_LINK_LIBRARIES)
    # The pattern also finds a name inside a generator expression such as $<LINK_ONLY:...>.
    string(REGEX MATCHALL "fogline_[a-z0-9_]+" linked "${own};${passed_on}")
    list(REMOVE_DUPLICATES linked)
    list(JOIN linked " " linked)
    string(APPEND lines "${library} ${folders} ${linked}\n")
  endforeach()
  file(WRITE "${file}" "${lines}")
endfunction()

# fogline_add_role(NAME): builds *.cc of this folder as the library fogline_NAME (the algorithm of a
# role), and NAME_main.cc as the program fogline-NAME. Every role's folder has this shape.
function(fogline_add_role name)
  fogline_add_library(${name})
  target_link_libraries(fogline_${name} PUBLIC fogline_lcmtypes fogline_scenario)
  add_executable(fogline-${name} ${name}_main.cc)
  target_compile_options(fogline-${name} PRIVATE ${FOGLINE_COLD_CODE})
  target_link_libraries(fogline-${name} PRIVATE fogline_${name} fogline_runtime)
endfunction()

# fogline_add_campaign(NAME TIMEOUT_S COMMAND ARGUMENT... [PROGRAMS TARGET...] [PROPERTIES ...]):
# adds a test with the label campaign. The default build leaves PROGRAMS out. The test
# campaign.Programs builds them, and runs before a campaign that needs them.
function(fogline_add_campaign name timeout_s)
  cmake_parse_arguments(PARSE_ARGV 2 campaign "" "" "COMMAND;PROGRAMS;PROPERTIES")
  add_test(NAME ${name} COMMAND ${campaign_COMMAND})
  set_tests_properties(${name} PROPERTIES LABELS campaign TIMEOUT ${timeout_s}
                       ${campaign_PROPERTIES})
  if(campaign_PROGRAMS)
    set_property(TEST ${name} APPEND PROPERTY FIXTURES_REQUIRED campaign_programs)
    set_target_properties(${campaign_PROGRAMS} PROPERTIES EXCLUDE_FROM_ALL ON)
    set_property(GLOBAL APPEND PROPERTY FOGLINE_CAMPAIGN_PROGRAMS ${campaign_PROGRAMS})
  endif()
endfunction()

# fogline_build_campaign_programs(): adds the test campaign.Programs. Call it after all calls of
# fogline_add_campaign().
function(fogline_build_campaign_programs)
  get_property(programs GLOBAL PROPERTY FOGLINE_CAMPAIGN_PROGRAMS)
  list(REMOVE_DUPLICATES programs)
  fogline_add_campaign(campaign.Programs 1800
    COMMAND "${CMAKE_COMMAND}" --build "${CMAKE_BINARY_DIR}" --target ${programs}
    PROPERTIES FIXTURES_SETUP campaign_programs)
endfunction()

# The time limit of each test without the label campaign, in seconds. The limit is several times
# kPatience, the longest time that a test waits for one condition (tests/support/command.h). So the
# limit ends only a test that hangs, even on a busy machine.
set(FOGLINE_TEST_LIMIT_S 900)

# fogline_add_test_program(NAME LIBS...): builds every NAME/**/*_test.cc into the program
# NAME_tests. With FOGLINE_UNITY, all files of a folder are compiled as one.
function(fogline_add_test_program name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${name}/*_test.cc")
  add_executable(${name}_tests ${sources})
  foreach(source IN LISTS sources)
    get_filename_component(folder "${source}" DIRECTORY)
    file(RELATIVE_PATH folder "${CMAKE_CURRENT_SOURCE_DIR}" "${folder}")
    string(MAKE_C_IDENTIFIER "${folder}" group)
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${name}_tests PROPERTIES UNITY_BUILD ${FOGLINE_UNITY} UNITY_BUILD_MODE GROUP)
  # All test programs share one precompiled header, because a precompiled header takes 86 MB. The
  # header does not contain the matchers of GoogleMock, because they would take 18 MB more, and only
  # some of the files use them. All programs that share the header must have the same compile
  # definitions. The library boost_asio adds compile definitions, so all test programs link
  # boost_asio.
  get_property(precompiled GLOBAL PROPERTY FOGLINE_PRECOMPILED_TESTS)
  if(precompiled)
    target_precompile_headers(${name}_tests REUSE_FROM ${precompiled})
  else()
    target_precompile_headers(${name}_tests PRIVATE <gtest/gtest.h>)
    set_property(GLOBAL PROPERTY FOGLINE_PRECOMPILED_TESTS ${name}_tests)
  endif()
  target_include_directories(${name}_tests PRIVATE "${PROJECT_SOURCE_DIR}")
  target_compile_definitions(${name}_tests PRIVATE
    FOGLINE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" FOGLINE_BINARY_DIR="${CMAKE_BINARY_DIR}")
  target_link_libraries(${name}_tests PRIVATE ${ARGN} boost_asio
    GTest::gtest GTest::gmock GTest::gtest_main)
endfunction()

# fogline_add_tests(NAME LIBS...): calls fogline_add_test_program(), and makes each TEST of the
# program a test of ctest. The names of the tests begin with NAME: "unit.RadarTest.Name".
function(fogline_add_tests name)
  fogline_add_test_program(${name} ${ARGN})
  # Of the tests that make a run in real time, only one runs at a time, because two such tests would
  # delay each other.
  set(realtime "*InRealtime*:*RealtimeTest.*:*UnderLoad*:DeafRoleTest.*:RealtimeHorizonTest.*")
  gtest_discover_tests(${name}_tests TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST
    TEST_FILTER "-${realtime}"
    DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${FOGLINE_TEST_LIMIT_S} LABELS ${name})
  gtest_discover_tests(${name}_tests TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST
    TEST_LIST ${name}_realtime TEST_FILTER "${realtime}"
    DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${FOGLINE_TEST_LIMIT_S} LABELS ${name}
    RESOURCE_LOCK realtime)
endfunction()
