# Included by tools/CMakeLists.txt: makes report_page_parts.cpp and report_table_parts.cpp and names
# them in ${report_page_source} and ${report_table_source}.
set(ROADBED_DYGRAPHS_DIR /usr/share/javascript/dygraphs CACHE PATH
    "Folder with dygraph.min.js, dygraph.min.css and extras/synchronizer.js")
set(ROADBED_DYGRAPHS_LICENCE /usr/share/doc/libjs-dygraphs/copyright CACHE FILEPATH
    "The licence of dygraphs, shown in each report")
set(report_dygraphs_files
    ${ROADBED_DYGRAPHS_DIR}/dygraph.min.js ${ROADBED_DYGRAPHS_DIR}/dygraph.min.css
    ${ROADBED_DYGRAPHS_DIR}/extras/synchronizer.js ${ROADBED_DYGRAPHS_LICENCE})
foreach(file ${report_dygraphs_files})
  if(NOT EXISTS ${file})
    message(FATAL_ERROR
      "${file} is missing: it draws the plots of the report.\n"
      "Install it with 'apt-get install libjs-dygraphs' (tools/setup does), or name its folder with "
      "-DROADBED_DYGRAPHS_DIR=… and its licence with -DROADBED_DYGRAPHS_LICENCE=….")
  endif()
endforeach()

set(report_page ${CMAKE_CURRENT_LIST_DIR}/page)
# In this order: what comes later uses what comes before.
set(report_scripts decode.js motion.js clock.js scene.js hypotheses.js cycle.js draw.js hidden.js map.js plots.js player.js report.js)
list(TRANSFORM report_scripts PREPEND ${report_page}/)
# What the page of a map draws with.
set(map_scripts decode view map_data grid locate colours tiles paint things overlays canvas)
list(TRANSFORM map_scripts REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/map/page/scripts/\\1.js")
list(JOIN map_scripts , map_scripts)
list(JOIN report_scripts , report_scripts)
set(report_page_source ${CMAKE_CURRENT_BINARY_DIR}/report_page_parts.cpp)
roadbed_embed(OUT ${report_page_source} HEADER roadbed/tools/report/page_parts.h
  NAMESPACE "roadbed::tools::inline report"
  PARTS kPageTemplate=${report_page}/template.html kPageCss=${PROJECT_SOURCE_DIR}/map/page/map_colours.css,${report_page}/report.css
        kPageJs=${map_scripts},${report_scripts} kDygraphsCss=${ROADBED_DYGRAPHS_DIR}/dygraph.min.css
        kDygraphsJs=${ROADBED_DYGRAPHS_DIR}/dygraph.min.js
        kSynchronizerJs=${ROADBED_DYGRAPHS_DIR}/extras/synchronizer.js
        kDygraphsLicence=${ROADBED_DYGRAPHS_LICENCE})
set(report_table_source ${CMAKE_CURRENT_BINARY_DIR}/report_table_parts.cpp)
roadbed_embed(OUT ${report_table_source} HEADER roadbed/tools/report/table_script.h
  NAMESPACE "roadbed::tools::inline report"
  PARTS kTableScript=${report_page}/table.js kTableCss=${report_page}/table.css)
