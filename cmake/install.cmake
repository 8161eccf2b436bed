# `cmake --install build --prefix DIR` installs into DIR: the programs, the message types (C++
# headers, and the jar if it was built), and the package for C++ roles of other projects.
# find_package(fogline) gives these projects the target fogline::runtime.
include(CMakePackageConfigHelpers)

set(programs fogline fogline-calibrate fogline-experiment fogline-study fogline-recorder fogline-relay
    fogline-web)
foreach(service IN LISTS FOGLINE_SERVICES)
  list(APPEND programs fogline-${service})
endforeach()
install(TARGETS ${programs} RUNTIME DESTINATION bin)

install(TARGETS fogline_hear_loopback LIBRARY DESTINATION lib)
if(TARGET fogline_sumo)
  install(TARGETS fogline_sumo LIBRARY DESTINATION lib/fogline)  # load_sumo.h finds it there
endif()

foreach(part IN ITEMS common lcmtypes scenario wire runtime)
  set_target_properties(fogline_${part} PROPERTIES EXPORT_NAME ${part})
  install(TARGETS fogline_${part} EXPORT fogline-targets ARCHIVE DESTINATION lib)
endforeach()
install(EXPORT fogline-targets NAMESPACE fogline:: DESTINATION lib/cmake/fogline)
install(FILES services/algorithm.h services/graph.h services/input_state.h DESTINATION include/services)
install(DIRECTORY common DESTINATION include FILES_MATCHING PATTERN "*.h")
install(DIRECTORY services/runtime DESTINATION include/services FILES_MATCHING PATTERN "*.h")
install(DIRECTORY scenario/ DESTINATION include/scenario
  FILES_MATCHING PATTERN "*.h" PATTERN "bad" EXCLUDE PATTERN "ensemble" EXCLUDE)
install(FILES scenario/paper.json scenario/dense_fog.json scenario/recorded_lead.json
  scenario/sumo_queue.json
  scenario/scenario.schema.json DESTINATION share/fogline/scenario)
install(DIRECTORY scenario/data scenario/ensemble DESTINATION share/fogline/scenario)

set(config "${CMAKE_CURRENT_BINARY_DIR}/fogline-config")
configure_package_config_file(cmake/fogline-config.cmake.in "${config}.cmake"
  INSTALL_DESTINATION lib/cmake/fogline NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${config}-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${config}.cmake" "${config}-version.cmake" DESTINATION lib/cmake/fogline)
