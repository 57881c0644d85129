# What `cpack` makes of what library.cmake and tools/python install: Debian packages. tools/package calls it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME roadbed)
set(CPACK_PACKAGE_CONTACT "roadbed maintainers <maintainers@roadbed.invalid>" CACHE STRING
  "Who answers for the packages: a name and an address")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "road maps as exact lanes, routes, plans and audits")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program library)
if(ROADBED_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME roadbed)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Digital road maps (OpenDRIVE, Lanelet2, CommonRoad) become exact lanes,
lane-level routes, smooth reference lines and driven trajectories; point
clouds become occupancy; and every drive can be audited against it, with
a proof that can be checked.

Longitude and latitude need PROJ, objects in point clouds PCL; without
these recommended libraries everything else works.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libroadbed-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "Development files: headers, static libraries and CMake files of roadbed.
Lanes and queries, lane-level routes, reference lines, the planning cycle,
controllers, occupancy, and audits with certificates.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-roadbed)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/python/postinst
                                              ${CMAKE_CURRENT_LIST_DIR}/python/prerm)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Python module of roadbed: road maps, routes, plans, drives and audits
Maps of any format, lanes, routes, reference lines, the planning cycle,
closed-loop drives with a planner of one's own, occupancy and audits, by
arrays of numpy.")

set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian_files.cmake)
set(CPACK_ROADBED_SOURCE ${PROJECT_SOURCE_DIR})
set(CPACK_ROADBED_MODULES ${CMAKE_INSTALL_LIBDIR}/roadbed)
include(CPack)
