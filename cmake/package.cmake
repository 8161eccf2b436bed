# `ninja -C build fogline_packages` makes Debian packages in build/packages: fogline (programs,
# scenarios, man pages, completion, systemd unit), fogline-dev (headers, static libraries, CMake
# package, .lcm files), and python3-fogline-lab if there is a component `python`. The command needs
# Debian's packages dpkg-dev, file and help2man.
set(FOGLINE_MAINTAINER "the Fogline authors <fogline@fogline.invalid>" CACHE STRING
  "Maintainer of the Debian packages, as NAME <ADDRESS>")

# A package has the files of two components: NAME and NAME-system. The component NAME-system has the
# files outside of the prefix, and the documents. `cmake --install` does not install this component.
set(parts fogline dev)
get_cmake_property(components COMPONENTS)
if("python" IN_LIST components)
  list(APPEND parts python)
endif()
set(fogline_package fogline)
set(dev_package fogline-dev)
set(python_package python3-fogline-lab)

set(package_files "${CMAKE_CURRENT_LIST_DIR}/package")
install(FILES "${package_files}/fogline/fogline@.service" DESTINATION /lib/systemd/system
  COMPONENT fogline-system EXCLUDE_FROM_ALL)
install(FILES "${package_files}/fogline/fogline.default" DESTINATION /etc/default RENAME fogline
  COMPONENT fogline-system EXCLUDE_FROM_ALL)
install(CODE "
  set(PROGRAMS \"${FOGLINE_PROGRAMS}\")
  set(PROGRAM_FOLDER \"${CMAKE_RUNTIME_OUTPUT_DIRECTORY}\")
  set(VERSION \"${PROJECT_VERSION}\")
  set(OUT \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/man/man1\")
  include(\"${package_files}/man_pages.cmake\")"
  COMPONENT fogline-system EXCLUDE_FROM_ALL)
foreach(part IN LISTS parts)
  install(CODE "
    set(SOURCE \"${PROJECT_SOURCE_DIR}\")
    set(PACKAGE \"${${part}_package}\")
    set(MAINTAINER \"${FOGLINE_MAINTAINER}\")
    set(OUT \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/doc/${${part}_package}\")
    include(\"${package_files}/documents.cmake\")"
    COMPONENT ${part}-system EXCLUDE_FROM_ALL)
  list(APPEND CPACK_COMPONENTS_ALL ${part} ${part}-system)
  string(TOUPPER "${part}" PART)
  set(CPACK_COMPONENT_${PART}_GROUP ${part})
  set(CPACK_COMPONENT_${PART}-SYSTEM_GROUP ${part})
  set(CPACK_DEBIAN_${PART}_PACKAGE_NAME ${${part}_package})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fogline)
set(CPACK_PACKAGE_CONTACT "${FOGLINE_MAINTAINER}")
set(CPACK_SET_DESTDIR ON)  # some files are outside of the prefix
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_FOGLINE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FOGLINE_PACKAGE_SHLIBDEPS ON)
# dpkg-shlibdeps does not find matio, because the program loads matio at run time (matio_library.h).
get_property(matio_package GLOBAL PROPERTY FOGLINE_MATIO_PACKAGE)
set(CPACK_DEBIAN_FOGLINE_PACKAGE_DEPENDS "${matio_package}")
set(CPACK_DEBIAN_FOGLINE_PACKAGE_RECOMMENDS "liblcm-bin, gnuplot-nox | gnuplot")
set(CPACK_DEBIAN_FOGLINE_PACKAGE_SUGGESTS
  "default-jre, fogline-dev, libjchart2d-java, liblcm-java, openssh-client")
# The package has its own postinst and postrm. Without them, CPack would write scripts that only
# call ldconfig, and ldconfig does not search lib/fogline.
foreach(file IN ITEMS conffiles postinst prerm postrm)
  list(APPEND CPACK_DEBIAN_FOGLINE_PACKAGE_CONTROL_EXTRA "${package_files}/fogline/${file}")
endforeach()
set(CPACK_DEBIAN_FOGLINE_DESCRIPTION "distributed testbed for traded control in fog
Who should drive, the automation or the person, when fog makes radar and LiDAR
disagree? Each part of the car is a process on an LCM network. Each part can be
replaced, or can run on another machine. A run has the same result, bit by bit,
on any transport.
.
This package has the programs, the scenarios and a systemd unit for roles.")

set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libfmt-dev, liblcm-dev, librandom123-dev, libsodium-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "fogline (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEV_DESCRIPTION "distributed testbed for traded control in fog (development files)
Fogline runs each part of a car as a process on an LCM network.
.
This package has what a part of another project needs: the C++ headers, static
libraries and CMake package of Fogline's runtime, and the message types as .lcm
files for lcm-gen.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
# The extension module is made for one version of Python, so the package depends on that version.
get_property(python_depends GLOBAL PROPERTY FOGLINE_PYTHON_DEPENDS)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${python_depends}, fogline (= ${PROJECT_VERSION})")
foreach(file IN ITEMS postinst prerm)
  list(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${package_files}/python/${file}")
endforeach()
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-pandas")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "distributed testbed for traded control in fog (Python)
Fogline runs each part of a car as a process on an LCM network.
.
This package has the Python module fogline_lab: logs as pandas tables, runs,
tables and sweeps, live messages, and roles in Python.")
include(CPack)

# CPack with Ninja builds no programs, so this target depends on the programs.
set(packages "${CMAKE_BINARY_DIR}/packages")
add_custom_target(fogline_packages
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${packages}"
  COMMAND "${CMAKE_CPACK_COMMAND}" --config "${CMAKE_BINARY_DIR}/CPackConfig.cmake" -B "${packages}"
  COMMENT "Making Debian packages in ${packages}"
  VERBATIM)
add_dependencies(fogline_packages fogline_programs)
if(TARGET fogline_python)
  add_dependencies(fogline_packages fogline_python)
endif()
