# Uses help2man to make a man page from the --help of each program and each verb. Writes the pages
# into OUT. `fogline --complete` names the verbs. Needs PROGRAMS, PROGRAM_FOLDER and VERSION.
cmake_policy(VERSION 3.25)
find_program(HELP2MAN help2man)
if(NOT HELP2MAN)
  message(FATAL_ERROR "there is no help2man: apt-get install help2man")
endif()
file(MAKE_DIRECTORY "${OUT}")
set(corrections "${CMAKE_CURRENT_LIST_DIR}/man_page.awk")

# man_page(NAME SEE_ALSO PROGRAM ARGUMENT...): writes NAME.1.gz from `PROGRAM ARGUMENT... --help`.
function(man_page name see_also program)
  list(TRANSFORM see_also REPLACE "(.+)" ".BR \\1 (1)")
  list(JOIN see_also ",\n" see_also)
  file(WRITE "${OUT}/see_also" "[see also]\n${see_also}\n")
  execute_process(COMMAND "${PROGRAM_FOLDER}/${program}" ${ARGN} --help OUTPUT_VARIABLE help
    COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "[.]?\n.*" "" purpose "${help}")
  list(JOIN ARGN " " arguments)
  execute_process(
    COMMAND "${HELP2MAN}" --no-info --section=1 "--name=${purpose}" --manual=Fogline
            "--source=Fogline ${VERSION}" "--version-string=${name} ${VERSION}"
            "--include=${OUT}/see_also" "${PROGRAM_FOLDER}/${program} ${arguments}"
    COMMAND awk -f "${corrections}"
    COMMAND gzip -9n
    OUTPUT_FILE "${OUT}/${name}.1.gz"
    COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE "${OUT}/see_also")
endfunction()

# verbs(OUTPUT WORD...): sets OUTPUT to the list of verbs that may follow `fogline WORD...`.
function(verbs output)
  execute_process(COMMAND "${PROGRAM_FOLDER}/fogline" --complete ${ARGN} "" OUTPUT_VARIABLE lines
    COMMAND_ERROR_IS_FATAL ANY)
  # Each line is WORD<tab>MEANING. The meanings are removed, because a ";" would split the list.
  string(REGEX REPLACE "\t[^\n]*" "" lines "${lines}")
  string(REGEX MATCHALL "[^\n]+" lines "${lines}")
  set(${output} "${lines}" PARENT_SCOPE)
endfunction()

set(pages "")
verbs(all)
foreach(verb IN LISTS all)
  man_page(fogline-${verb} fogline fogline ${verb})
  list(APPEND pages fogline-${verb})
  execute_process(COMMAND "${PROGRAM_FOLDER}/fogline" ${verb} --help OUTPUT_VARIABLE help)
  if(NOT help MATCHES "\nSubcommands:\n")
    continue()
  endif()
  verbs(actions ${verb})
  foreach(action IN LISTS actions)
    man_page(fogline-${verb}-${action} "fogline;fogline-${verb}" fogline ${verb} ${action})
    list(APPEND pages fogline-${verb}-${action})
  endforeach()
endforeach()
foreach(program IN LISTS PROGRAMS)
  if(program STREQUAL "fogline" OR program IN_LIST pages)
    continue()
  endif()
  man_page(${program} fogline ${program})
  list(APPEND pages ${program})
endforeach()
list(SORT pages)
man_page(fogline "${pages}" fogline)
