# `cmake --install build --prefix DIR` installs into DIR: the programs, the scenarios, completion
# for shells, the message types (.lcm files, C++ headers, and the jar if it was built), and the
# package for C++ roles of other projects. find_package(fogline) gives these projects the target
# fogline::runtime. Each part belongs to a component; cmake/package.cmake makes a Debian package of
# each component.
include(CMakePackageConfigHelpers)

set(FOGLINE_PROGRAMS fogline fogline-calibrate fogline-experiment fogline-study fogline-recorder
    fogline-relay fogline-web)
foreach(service IN LISTS FOGLINE_SERVICES)
  list(APPEND FOGLINE_PROGRAMS fogline-${service})
endforeach()
install(TARGETS ${FOGLINE_PROGRAMS} RUNTIME DESTINATION bin COMPONENT fogline)

if(TARGET fogline_sumo)  # load_sumo.h looks for the module in lib/fogline
  install(TARGETS fogline_sumo LIBRARY DESTINATION lib/fogline COMPONENT fogline)
endif()
# lib/fogline has the libraries that only the programs use.
install(TARGETS fogline_hear_loopback LIBRARY DESTINATION lib/fogline COMPONENT fogline)
install(DIRECTORY scenario/ DESTINATION share/fogline/scenario COMPONENT fogline
  PATTERN "bad" EXCLUDE PATTERN "io" EXCLUDE PATTERN "sections" EXCLUDE
  REGEX "/scenario/(CMakeLists.txt|README.md)$" EXCLUDE)
include(package/completion)

# include/fogline contains the headers of the message types. Its subfolders, such as common/,
# contain all other headers.
foreach(part IN ITEMS common lcmtypes scenario wire runtime)
  set_target_properties(fogline_${part} PROPERTIES EXPORT_NAME ${part})
  install(TARGETS fogline_${part} EXPORT fogline-targets ARCHIVE DESTINATION lib COMPONENT dev)
endforeach()
install(EXPORT fogline-targets NAMESPACE fogline:: DESTINATION lib/cmake/fogline COMPONENT dev)
install(FILES services/algorithm.h services/graph.h services/input_state.h
  DESTINATION include/fogline/services COMPONENT dev)
install(DIRECTORY common DESTINATION include/fogline COMPONENT dev FILES_MATCHING PATTERN "*.h")
install(DIRECTORY services/runtime DESTINATION include/fogline/services COMPONENT dev
  FILES_MATCHING PATTERN "*.h")
install(DIRECTORY scenario/sections scenario/io DESTINATION include/fogline/scenario COMPONENT dev
  FILES_MATCHING PATTERN "*.h")
install(DIRECTORY lcmtypes/ DESTINATION share/fogline/lcmtypes COMPONENT dev
  FILES_MATCHING PATTERN "*.lcm")

set(config "${CMAKE_CURRENT_BINARY_DIR}/fogline-config")
configure_package_config_file(cmake/fogline-config.cmake.in "${config}.cmake"
  INSTALL_DESTINATION lib/cmake/fogline NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${config}-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${config}.cmake" "${config}-version.cmake" DESTINATION lib/cmake/fogline COMPONENT dev)
