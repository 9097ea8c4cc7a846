# takt_room(name SOURCES ... [DEPENDS takt::x ...] [PRIVATE_DEPENDS pkg ...])
# One room of the house: a static library with public headers in include/takt/<name>.
# A room without sources is a header-only library.
function(takt_room name)
    cmake_parse_arguments(ROOM "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
    set(target takt_${name})
    if(ROOM_SOURCES)
        add_library(${target} STATIC ${ROOM_SOURCES})
        target_include_directories(${target}
            PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/include
            PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
        target_link_libraries(${target} PUBLIC ${ROOM_DEPENDS}
            PRIVATE takt_warnings ${ROOM_PRIVATE_DEPENDS})
    else()
        add_library(${target} INTERFACE)
        target_include_directories(${target} INTERFACE ${CMAKE_CURRENT_SOURCE_DIR}/include)
        target_link_libraries(${target} INTERFACE ${ROOM_DEPENDS})
    endif()
    add_library(takt::${name} ALIAS ${target})
endfunction()
