# cmake -DOUT=F.cpp -DHEADER=roadbed/… -DNAMESPACE=a::inline\ b "-DPARTS=kName=FILE,FILE;…" -P embed.cmake
# Writes files as constants into a source, so that the program needs no file beside itself; several
# files of one part stand one after the other. Scripts and styles of the project's own pages lose the
# comments and indents that only readers of the source need. A part that could end its own <script> or <style>
# element stops the build. `roadbed_embed` in the top CMakeLists.txt calls it.
function(read_part file result)
  file(READ "${file}" text)
  string(REGEX REPLACE "\n?(//|/\\*)# sourceMappingURL=[^\n]*" "" text "${text}")
  if(text MATCHES "</[sS][cC][rR][iI][pP][tT]|</[sS][tT][yY][lL][eE]|<!--" AND NOT file MATCHES "html$")
    message(FATAL_ERROR "${file} holds '${CMAKE_MATCH_0}', which would break the page that it is put into")
  endif()
  if(file MATCHES "/page/.*\\.(js|css)$")
    string(REGEX REPLACE "(^|\n) *//[^\n]*" "\\1" text "${text}")
    string(REGEX REPLACE "(^|\n) */\\*([^*]|\\*+[^*/])*\\*+/ *(\n|$)" "\\1" text "${text}")
    string(REGEX REPLACE "\n[ \n]+" "\n" text "${text}")
  endif()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

set(source "// Made by map/files/embed.cmake; do not edit.\n#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n\n")
foreach(part ${PARTS})
  string(REGEX MATCH "^([A-Za-z]+)=(.*)$" matched "${part}")
  set(name ${CMAKE_MATCH_1})
  string(REPLACE "," ";" files "${CMAKE_MATCH_2}")
  set(whole "")
  foreach(file ${files})
    read_part("${file}" text)
    string(APPEND whole "${text}\n")
  endforeach()
  string(APPEND source "const std::string_view ${name} = R\"roadbed(${whole})roadbed\";\n\n")
endforeach()
string(APPEND source "}  // namespace ${NAMESPACE}\n")
file(WRITE ${OUT} "${source}")
