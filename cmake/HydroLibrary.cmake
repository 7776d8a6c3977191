# One call for each library and each program of a room.
#
# The standard library's headers take a fifth of all compile time. Builds of everything (presets release and
# asan) precompile them once for each set of flags. The preset dev compiles every file alone, and so finds
# missing includes.
option(HYDRO_PRECOMPILE "Precompile the standard library's headers" OFF)
# These builds also compile a library's files in batches of 24, because most of the compile time goes into
# reading the same headers and templates. So names in anonymous namespaces are unique within a library.
option(HYDRO_UNITY "Compile each library's files in batches" OFF)
# GCC 12 does not treat precompiled headers as system headers, and warns falsely about strings in its own (its
# bug 105651).
if(HYDRO_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
endif()
# LCM's flags contain this one. Headers precompiled without it would not fit sources that use LCM.
add_compile_options(-pthread)

# Under the sanitizers, files that only compute are optimised a little and compiled without the check of every
# access's alignment. They read no raw bytes, and that check takes much of the compile time. Optimising triples
# their compile time, and pays only where the tests of these folders themselves are run (./check --full).
option(HYDRO_OPTIMISE_COMPUTES "Under the sanitizers, optimise files that only compute" ON)
set(HYDRO_COMPUTES_OPTIONS "")
if(HYDRO_SANITIZE)
  set(HYDRO_COMPUTES_OPTIONS -fno-sanitize=alignment,object-size)
  if(HYDRO_OPTIMISE_COMPUTES)
    list(PREPEND HYDRO_COMPUTES_OPTIONS -O1)
  endif()
endif()

if(HYDRO_PRECOMPILE)
  foreach(flavour precompiled precompiled_computes)
    add_library(hydro_${flavour} OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled.cc)
    target_precompile_headers(hydro_${flavour} PRIVATE <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <map>
                                                       <memory> <optional> <set> <sstream> <string> <thread> <variant> <vector>)
  endforeach()
  target_compile_options(hydro_precompiled_computes PRIVATE ${HYDRO_COMPUTES_OPTIONS})
endif()

# hydro_library(NAME [OBJECTS] [COMPUTES] [INSTALLED] SOURCES FILES... [HEADERS FILES...] [PUBLIC LIBS...]
# [PRIVATE LIBS...]) makes a static library, hydro_NAME, which others know as hydro::NAME. Its headers are
# included by their path from the root, both here and where they are installed (include/hydro). COMPUTES: see
# above. INSTALLED: the library and the headers of its folder are part of what other projects build on
# (find_package(hydro), cmake/hydroConfig.cmake.in). HEADERS limits this to the given headers, where the
# folder has other libraries. OBJECTS: makes objects without a library around them.
function(hydro_library name)
  cmake_parse_arguments(arg "OBJECTS;COMPUTES;INSTALLED" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "hydro_library(${name}): unknown: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  set(type STATIC)
  if(arg_OBJECTS)
    set(type OBJECT)
  endif()
  add_library(${name} ${type} ${arg_SOURCES})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                            $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/hydro>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_link_libraries(${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  set(flavour precompiled)
  if(arg_COMPUTES)
    target_compile_options(${name} PRIVATE ${HYDRO_COMPUTES_OPTIONS})
    set(flavour precompiled_computes)
  endif()
  hydro_use_precompiled(${name} hydro_${flavour})
  hydro_compile_in_batches(${name})
  if(arg_INSTALLED)
    if(NOT arg_OBJECTS)
      hydro_install_library(${name})
    endif()
    if(arg_HEADERS)
      cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE room)
      hydro_install_public(${room} ${arg_HEADERS})
    else()
      hydro_install_headers(${arg_SOURCES})
    endif()
  endif()
endfunction()

# hydro_use_precompiled(NAME OTHER) takes the headers that OTHER has precompiled, with the same flags.
function(hydro_use_precompiled name other)
  if(HYDRO_PRECOMPILE)
    target_precompile_headers(${name} REUSE_FROM ${other})
  endif()
endfunction()

function(hydro_compile_in_batches name)
  if(HYDRO_UNITY)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 24)
  endif()
endfunction()

# hydro_install_headers(SOURCES...) installs the headers beside these sources of the current folder.
function(hydro_install_headers)
  set(folders "")
  foreach(source ${ARGN})
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(IS_PREFIX CMAKE_CURRENT_SOURCE_DIR ${folder} inside)  # not what is generated, nor effects of the user's own
    if(inside)
      list(APPEND folders ${folder})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(folder ${folders})
    file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.h)
    list(FILTER headers EXCLUDE REGEX "/base/json_text\\.h$")  # of hydro_json, which is not installed
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE room)
    hydro_install_public(${room} ${headers})
  endforeach()
endfunction()

# hydro_install_public(ROOM HEADERS...) installs what other projects build on, and what the reference shows
# (packaging/reference).
function(hydro_install_public room)
  install(FILES ${ARGN} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hydro/${room} COMPONENT development)
  install(FILES ${ARGN} DESTINATION include/hydro/${room} COMPONENT reference EXCLUDE_FROM_ALL)
endfunction()

# hydro_install_library(hydro_NAME) exports a library as hydro::NAME.
function(hydro_install_library name)
  string(REGEX REPLACE "^hydro_" "" short_name ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${short_name})
  add_library(hydro::${short_name} ALIAS ${name})
  install(TARGETS ${name} EXPORT hydroTargets COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY HYDRO_INSTALLED_LIBRARIES ${name})
endfunction()

# hydro_program(NAME SOURCES FILES... LIBS LIBS...) makes a program and installs it with a man page and
# completions (packaging/help).
function(hydro_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "hydro_program(${name}): unknown: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBS})
  if(NOT arg_SOURCES MATCHES "\\.c(;|$)")
    hydro_use_precompiled(${name} hydro_precompiled)
  endif()
  install(TARGETS ${name})
  set_property(GLOBAL APPEND PROPERTY HYDRO_PROGRAMS ${name})
endfunction()

# hydro_script(FILE) does the same for a script, whose --help has the same form.
function(hydro_script file)
  install(PROGRAMS ${file} TYPE BIN)
  set_property(GLOBAL APPEND PROPERTY HYDRO_SCRIPTS ${file})
endfunction()
