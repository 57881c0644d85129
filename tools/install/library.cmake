# What `cmake --install` puts where. The library of a module, roadbed::map and the like, is made of
# the objects of its folders, without compiling anything again: static archives, or with
# BUILD_SHARED_LIBS shared libraries. README.md beside this file says what is public.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(ROADBED_MODULE_FOLDER ${CMAKE_INSTALL_LIBDIR}/roadbed)  # PROJ and PCL, opened at run time
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/roadbed)
set(ROADBED_LIBRARY_KIND STATIC)
if(BUILD_SHARED_LIBS)
  set(ROADBED_LIBRARY_KIND SHARED)
endif()

# roadbed_add_module(map FOLDERS REGEX [OBJECTS TARGET…] USES geometry… PRIVATE fmt::fmt…)
function(roadbed_add_module module)
  cmake_parse_arguments(arg "" "FOLDERS" "OBJECTS;USES;PRIVATE" ${ARGN})
  get_property(folders GLOBAL PROPERTY ROADBED_FOLDERS)
  list(FILTER folders INCLUDE REGEX ${arg_FOLDERS})
  set(objects)
  foreach(folder ${folders})
    string(REPLACE "/" "_" target roadbed_${folder})
    list(APPEND objects $<TARGET_OBJECTS:${target}>)
  endforeach()
  foreach(target ${arg_OBJECTS})
    list(APPEND objects $<TARGET_OBJECTS:${target}>)
  endforeach()
  set(library roadbed_${module}_library)
  add_library(${library} ${ROADBED_LIBRARY_KIND} ${objects})
  set_target_properties(${library} PROPERTIES
    EXPORT_NAME ${module} OUTPUT_NAME roadbed_${module} LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib INSTALL_RPATH $ORIGIN)
  target_compile_features(${library} INTERFACE cxx_std_20)
  target_include_directories(${library} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM arg_USES REPLACE "(.+)" "roadbed_\\1_library")
  target_link_libraries(${library} PUBLIC Eigen3::Eigen ${arg_USES} PRIVATE ${arg_PRIVATE})
  install(TARGETS ${library} EXPORT roadbedTargets COMPONENT library
    LIBRARY NAMELINK_COMPONENT library)
endfunction()

# Found in folders, whose targets are not seen here.
find_package(pugixml REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(octomap REQUIRED)

# Libraries by name and not by path: where they are is the matter of who links.
roadbed_add_module(geometry FOLDERS "^geometry/" OBJECTS roadbed_geometry_exact
  PRIVATE fmt::fmt gmp mpfr)
roadbed_add_module(map FOLDERS "^map(/|$)(([^o]|op).*)?$" USES geometry
  PRIVATE fmt::fmt pugixml::pugixml SQLite::SQLite3 nettle xxhash z lz4 zstd GeographicLib
          ${CMAKE_DL_LIBS})
roadbed_add_module(occupancy FOLDERS "^map/occupancy/" USES map
  PRIVATE fmt::fmt octomap octomath lzf ${CMAKE_DL_LIBS})
roadbed_add_module(control FOLDERS "^control$" USES geometry PRIVATE fmt::fmt)
roadbed_add_module(planning FOLDERS "^planning(/|$)" USES occupancy control PRIVATE fmt::fmt)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/roadbedConfig.cmake.in
  ${PROJECT_BINARY_DIR}/install/roadbedConfig.cmake INSTALL_DESTINATION ${package_folder})
# Before 1.0 the second number changes with what others build on.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/install/roadbedConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/install/roadbedConfig.cmake
              ${PROJECT_BINARY_DIR}/install/roadbedConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT library)
install(EXPORT roadbedTargets NAMESPACE roadbed:: DESTINATION ${package_folder} COMPONENT library)

# The headers are looked for when they are installed, so that no change of one configures anew.
install(CODE "set(include_folder \"${CMAKE_INSTALL_INCLUDEDIR}\")
set(source_folder \"${PROJECT_SOURCE_DIR}\")" COMPONENT library)
install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/install_headers.cmake COMPONENT library)

# The program, and what it opens.
install(TARGETS roadbed COMPONENT program)
foreach(opened roadbed_proj roadbed_pcl)
  if(TARGET ${opened})
    install(TARGETS ${opened} LIBRARY DESTINATION ${ROADBED_MODULE_FOLDER} COMPONENT program)
  endif()
endforeach()

install(DIRECTORY ${PROJECT_BINARY_DIR}/share/ DESTINATION ${CMAKE_INSTALL_DATADIR} OPTIONAL
  COMPONENT program)  # manual pages and completions

# The pages of the public headers: `cmake --build build --target doc`.
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/public_headers.txt headers)
  list(TRANSFORM headers PREPEND ${PROJECT_SOURCE_DIR}/)
  list(JOIN headers " " ROADBED_PUBLIC_HEADERS)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/Doxyfile.in ${PROJECT_BINARY_DIR}/install/Doxyfile @ONLY)
  add_custom_target(doc
    COMMAND ${CMAKE_CURRENT_LIST_DIR}/write_pages ${PROJECT_BINARY_DIR} VERBATIM)
endif()

include(${CMAKE_CURRENT_LIST_DIR}/packages.cmake)
