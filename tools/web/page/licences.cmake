# cmake -DOUT=FILE -DPACKAGES=node_modules -P licences.cmake: writes the licences of the packages
# whose code is in the page.
set(text "")
foreach(package IN ITEMS uplot three)
  file(READ "${PACKAGES}/${package}/package.json" json)
  string(JSON version GET "${json}" version)
  file(READ "${PACKAGES}/${package}/LICENSE" licence)
  string(APPEND text "${package} ${version}\n\n${licence}\n\n")
endforeach()
file(WRITE "${OUT}" "${text}")
