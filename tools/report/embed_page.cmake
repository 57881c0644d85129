# Included by tools/CMakeLists.txt: makes report_page_parts.cpp and names it in
# ${report_page_source}.
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
set(report_scripts decode.js motion.js view.js clock.js scene.js cycle.js draw.js map.js plots.js player.js
                   report.js)
list(TRANSFORM report_scripts PREPEND ${report_page}/ OUTPUT_VARIABLE report_script_files)
set(report_page_source ${CMAKE_CURRENT_BINARY_DIR}/report_page_parts.cpp)
add_custom_command(
  OUTPUT ${report_page_source}
  COMMAND ${CMAKE_COMMAND} -DOUT=${report_page_source} -DDYGRAPHS=${ROADBED_DYGRAPHS_DIR}
          -DLICENCE=${ROADBED_DYGRAPHS_LICENCE} -DPAGE=${report_page} "-DSCRIPTS=${report_scripts}"
          -P ${CMAKE_CURRENT_LIST_DIR}/embed.cmake
  DEPENDS ${CMAKE_CURRENT_LIST_DIR}/embed.cmake ${report_page}/template.html ${report_page}/report.css
          ${report_script_files} ${report_dygraphs_files}
  COMMENT "Embedding the report's page" VERBATIM)
