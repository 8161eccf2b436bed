# cmake -DOUT=FILE.cc -DDIR=FOLDER -DHAS_UPLOT=BOOL -P assets.cmake: writes the definitions for
# assets.h. Each raw string contains one file, or several files one after the other. So the program
# contains its pages, and needs no path to them at run time.
set(uplot ../../node_modules/uplot)
set(assets
  kPageHtml=page.html
  kPageCss=base.css,page.css
  kModelJs=model.js
  kScrollJs=scroll.js
  kChartJs=chart.js
  kLegendJs=legend.js
  kCurvesJs=curves.js
  kFrontJs=front.js
  kPageJs=page.js
  kStudyHtml=study.html
  kStudyCss=study.css
  kStudyJs=study_axes.js,study.js)
set(uplot_assets
  kUplotJs=${uplot}/dist/uPlot.iife.min.js
  kUplotCss=${uplot}/dist/uPlot.min.css
  kUplotLicense=${uplot}/LICENSE)

set(source "#include \"tools/report/assets.h\"\n\nnamespace fogline::report::assets {\n\n")
if(HAS_UPLOT)
  list(APPEND assets ${uplot_assets})
else()
  foreach(name IN ITEMS kUplotJs kUplotCss kUplotLicense)
    string(APPEND source "const std::string_view ${name}{};\n")
  endforeach()
endif()
foreach(asset IN LISTS assets)
  string(REPLACE "=" ";" asset "${asset}")
  list(GET asset 0 name)
  list(GET asset 1 file)
  string(REPLACE "," ";" files "${file}")
  set(text)
  foreach(part IN LISTS files)
    file(READ "${DIR}/${part}" content)
    string(APPEND text "${content}")
  endforeach()
  string(APPEND source "const std::string_view ${name} = R\"asset(${text})asset\";\n")
endforeach()
set(version)
if(HAS_UPLOT)
  file(READ "${DIR}/${uplot}/package.json" package)
  string(JSON version GET "${package}" version)
endif()
string(APPEND source "const std::string_view kUplotVersion = \"${version}\";\n")
string(APPEND source "\n}  // namespace fogline::report::assets\n")
file(WRITE "${OUT}" "${source}")
