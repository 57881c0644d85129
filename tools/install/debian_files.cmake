# Run by cpack when the files of its packages are in place: adds what Debian wants beside them, and
# finds what they depend on.
cmake_policy(VERSION 3.25)
set(date $ENV{SOURCE_DATE_EPOCH})
if(NOT date)
  message(FATAL_ERROR "SOURCE_DATE_EPOCH is not set; tools/package sets it")
endif()
execute_process(COMMAND date --utc --rfc-email --date=@${date} OUTPUT_VARIABLE changed
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(changelog "roadbed (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * The changes are listed in tools/README.md of the source.

 -- ${CPACK_PACKAGE_CONTACT}  ${changed}
")

# dpkg-shlibdeps reads it.
set(control ${CPACK_TEMPORARY_DIRECTORY}/shlibdeps/debian)
file(WRITE ${control}/control "Source: roadbed\n\nPackage: roadbed\nArchitecture: any\n")

# Sets RESULT to what programs and libraries need, and RESULT_recommended to what others need more.
function(find_dependencies result needed recommended)
  list(TRANSFORM needed PREPEND -e OUTPUT_VARIABLE arguments)
  list(TRANSFORM recommended PREPEND -e)
  if(recommended)
    list(PREPEND recommended -dRecommends)
  endif()
  execute_process(COMMAND dpkg-shlibdeps --ignore-missing-info -O ${arguments} ${recommended}
    WORKING_DIRECTORY ${control}/.. OUTPUT_VARIABLE found COMMAND_ERROR_IS_FATAL ANY ERROR_QUIET)
  string(REGEX MATCH "shlibs:Depends=([^\n]*)" ignored "${found}")
  set(${result} "${CMAKE_MATCH_1}" PARENT_SCOPE)
  set(${result}_recommended "" PARENT_SCOPE)
  if(found MATCHES "shlibs:Recommends=([^\n]*)")
    set(${result}_recommended "${CMAKE_MATCH_1}" PARENT_SCOPE)
  endif()
endfunction()

foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} name)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr)
  set(package ${CPACK_DEBIAN_${name}_PACKAGE_NAME})
  set(documentation ${root}/share/doc/${package})
  configure_file(${CPACK_ROADBED_SOURCE}/tools/install/copyright ${documentation}/copyright COPYONLY)
  set(overrides ${CPACK_ROADBED_SOURCE}/tools/install/lintian_overrides/${package})
  if(EXISTS ${overrides})
    configure_file(${overrides} ${root}/share/lintian/overrides/${package} COPYONLY)
  endif()
  file(WRITE ${documentation}/changelog "${changelog}")
  file(GLOB_RECURSE pages ${root}/share/man/*.1)
  execute_process(COMMAND gzip -9n ${documentation}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

set(root ${CPACK_TEMPORARY_DIRECTORY}/program/usr)
file(GLOB modules ${root}/${CPACK_ROADBED_MODULES}/*.so)
find_dependencies(depends ${root}/bin/roadbed "${modules}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${depends}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "${depends_recommended}")

if(python IN_LIST CPACK_COMPONENTS_ALL)
  file(GLOB module ${CPACK_TEMPORARY_DIRECTORY}/python/usr/lib/python3/dist-packages/roadbed/*.so)
  find_dependencies(depends ${module} "")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy, \
roadbed (= ${CPACK_PACKAGE_VERSION}), ${depends}")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-geopandas, python3-shapely")
endif()

# What the archives are linked with: the packages of library.cmake's and roadbedConfig.cmake's names.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libgeographic-dev | \
libgeographiclib-dev, libgmp-dev, liblz4-dev, liblzf-dev, libmpfr-dev, liboctomap-dev, libpugixml-dev, \
libsqlite3-dev, libxxhash-dev, libzstd-dev, nettle-dev, zlib1g-dev")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "roadbed (= ${CPACK_PACKAGE_VERSION})")
