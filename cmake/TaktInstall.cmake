# What `cmake --install` and the Debian package put onto a machine: the command, one library, its headers,
# the schema and device files, and what other builds need to find it.
include(CMakePackageConfigHelpers)

install(TARGETS takt_command takt_library EXPORT takt-targets
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
foreach(room core wire fieldbus twin scheduler record program daemon cli)
    install(DIRECTORY runtime/${room}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
foreach(room planner axis plcopen config)
    install(DIRECTORY ${room}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
install(DIRECTORY config/schema/ DESTINATION ${CMAKE_INSTALL_DATADIR}/takt/schema)
install(DIRECTORY samples/devices/ DESTINATION ${CMAKE_INSTALL_DATADIR}/takt/devices)
install(FILES packaging/takt@.service DESTINATION lib/systemd/system)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(TAKT_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/takt)
install(EXPORT takt-targets NAMESPACE takt:: DESTINATION ${TAKT_CMAKE_DIR})
configure_package_config_file(packaging/takt-config.cmake.in ${CMAKE_BINARY_DIR}/takt-config.cmake
    INSTALL_DESTINATION ${TAKT_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/takt-config-version.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/takt-config.cmake ${CMAKE_BINARY_DIR}/takt-config-version.cmake
    DESTINATION ${TAKT_CMAKE_DIR})
configure_file(packaging/takt.pc.in ${CMAKE_BINARY_DIR}/takt.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/takt.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME takt)
set(CPACK_PACKAGE_CONTACT "the takt developers <takt@localhost>")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
