# What `cmake --install` and the Debian package put onto a machine: the command, one library, its headers,
# the schema and device files, and what other builds need to find it.
include(CMakePackageConfigHelpers)

# Before 1.0 every minor version may break programs, so the library's name carries both numbers.
set_target_properties(takt_library PROPERTIES EXPORT_NAME takt
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_compile_features(takt_library INTERFACE cxx_std_20)
# The command finds its library wherever the prefix is moved to.
file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(takt_command PROPERTIES EXPORT_NAME command
    INSTALL_RPATH "$ORIGIN/${lib_from_bin}")

install(TARGETS takt_command takt_library EXPORT takt-targets
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
foreach(room core wire fieldbus twin scheduler record bridge program daemon cli)
    install(DIRECTORY runtime/${room}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
foreach(room planner planner/roadmap axis plcopen config)
    install(DIRECTORY ${room}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
install(FILES ${CMAKE_BINARY_DIR}/runtime/program/include/takt/program/version.hpp
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/takt/program)
# Started by takt, not by people. The library finds it from where it lies itself.
install(TARGETS takt_bridge_process RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/takt)
install(FILES runtime/bridge/idl/takt.idl DESTINATION ${CMAKE_INSTALL_DATADIR}/takt/idl)
install(DIRECTORY config/schema/ DESTINATION ${CMAKE_INSTALL_DATADIR}/takt/schema)
install(DIRECTORY samples/devices/ DESTINATION ${CMAKE_INSTALL_DATADIR}/takt/devices)
# The package's script puts it to /etc/default/takt, unless there is one.
install(FILES packaging/takt.default DESTINATION ${CMAKE_INSTALL_DATADIR}/takt)
install(FILES packaging/takt@.service DESTINATION lib/systemd/system)
install(FILES packaging/takt.conf DESTINATION lib/sysusers.d)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)

set(TAKT_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/takt)
install(EXPORT takt-targets NAMESPACE takt:: DESTINATION ${TAKT_CMAKE_DIR})
configure_package_config_file(packaging/takt-config.cmake.in ${CMAKE_BINARY_DIR}/takt-config.cmake
    INSTALL_DESTINATION ${TAKT_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/takt-config-version.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/takt-config.cmake ${CMAKE_BINARY_DIR}/takt-config-version.cmake
    DESTINATION ${TAKT_CMAKE_DIR})

set(TAKT_PKGCONFIG_DIR ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH TAKT_PREFIX_FROM_PC ${TAKT_PKGCONFIG_DIR} ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" TAKT_PREFIX_FROM_PC ${TAKT_PREFIX_FROM_PC})
configure_file(packaging/takt.pc.in ${CMAKE_BINARY_DIR}/takt.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/takt.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME takt)
set(CPACK_PACKAGE_CONTACT "the takt developers <takt@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION electronics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY =)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/packaging/postinst)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
include(CPack)
