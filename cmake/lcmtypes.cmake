# lcm_add_types(TARGET DIR) adds the interface library TARGET. Its C++ headers are made from every
# DIR/*.lcm at build time. Debian's LCM has no CMake package for this task. If a JDK and LCM's jar
# are installed, the target TARGET_java makes lib/TARGET.jar, which lcm-spy needs to decode the
# messages.
find_program(LCM_GEN lcm-gen REQUIRED)

function(lcm_add_types target dir)
  file(GLOB lcm_files CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${dir}/*.lcm")
  set(out "${CMAKE_BINARY_DIR}/lcmtypes")
  set(headers)
  foreach(file IN LISTS lcm_files)
    get_filename_component(name "${file}" NAME_WE)
    list(APPEND headers "${out}/cpp/fogline/${name}.hpp")
  endforeach()
  add_custom_command(
    OUTPUT ${headers}
    COMMAND "${LCM_GEN}" -x --cpp-std c++11 --cpp-hpath "${out}/cpp" ${lcm_files}
    COMMAND "${PROJECT_SOURCE_DIR}/cmake/harden_decoders.sh" ${headers}
    DEPENDS ${lcm_files} "${PROJECT_SOURCE_DIR}/cmake/harden_decoders.sh"
    COMMENT "Generating C++ message types"
    VERBATIM)
  set(fields "${out}/cpp/fogline/fields.hpp")
  add_custom_command(
    OUTPUT "${fields}"
    COMMAND "${CMAKE_COMMAND}" "-DOUT=${fields}" "-DLCM_FILES=${lcm_files}"
            -P "${PROJECT_SOURCE_DIR}/cmake/message_fields.cmake"
    DEPENDS ${lcm_files} "${PROJECT_SOURCE_DIR}/cmake/message_fields.cmake"
    COMMENT "Generating field visitors of the message types"
    VERBATIM)
  set(fingerprint "${out}/cpp/fogline/fingerprint.hpp")
  add_custom_command(
    OUTPUT "${fingerprint}"
    COMMAND "${CMAKE_COMMAND}" "-DOUT=${fingerprint}" "-DLCM_FILES=${lcm_files}"
            -P "${PROJECT_SOURCE_DIR}/cmake/type_fingerprint.cmake"
    DEPENDS ${lcm_files} "${PROJECT_SOURCE_DIR}/cmake/type_fingerprint.cmake"
    COMMENT "Generating the fingerprint of the message types"
    VERBATIM)
  add_custom_target(${target}_headers DEPENDS ${headers} "${fields}" "${fingerprint}")
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_headers)
  target_include_directories(${target} SYSTEM INTERFACE "$<BUILD_INTERFACE:${out}/cpp>")
  target_include_directories(${target} INTERFACE "$<INSTALL_INTERFACE:include>")

  find_program(JAVAC javac)
  find_program(JAR jar)
  find_file(LCM_JAR lcm.jar PATHS /usr/share/java /usr/local/share/java)
  if(JAVAC AND JAR AND LCM_JAR)
    set(jar_file "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${target}.jar")
    add_custom_command(
      OUTPUT "${jar_file}"
      COMMAND "${CMAKE_COMMAND}" -E rm -rf "${out}/java" "${out}/classes"
      COMMAND "${CMAKE_COMMAND}" -E make_directory "${out}/classes" "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}"
      COMMAND "${LCM_GEN}" -j --jpath "${out}/java" ${lcm_files}
      COMMAND sh -c "'${JAVAC}' -nowarn -cp '${LCM_JAR}' -d '${out}/classes' '${out}'/java/fogline/*.java"
      COMMAND "${JAR}" cf "${jar_file}" -C "${out}/classes" .
      DEPENDS ${lcm_files}
      COMMENT "Compiling Java message types for lcm-spy"
      VERBATIM)
    add_custom_target(${target}_java ALL DEPENDS "${jar_file}")
  else()
    message(STATUS "No JDK or lcm.jar: lcm-spy will not decode Fogline's messages")
  endif()

  # Python types are made only on request: cmake --build build --target fogline_lcmtypes_python
  add_custom_target(${target}_python
    COMMAND "${LCM_GEN}" -p --ppath "${out}/python" ${lcm_files}
    COMMENT "Generating Python message types in ${out}/python")

  install(DIRECTORY "${out}/cpp/fogline" DESTINATION include COMPONENT dev)
  install(FILES "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${target}.jar" DESTINATION share/fogline
    COMPONENT fogline OPTIONAL)
endfunction()
