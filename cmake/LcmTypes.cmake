# lcm_wrap_cpp(TARGET FILES...) makes an interface library with the C++ classes that lcm-gen makes from the
# .lcm files, and with hydro/messages.hpp, which includes them all. (Debian's LCM 1.3.1 ships no CMake package
# and no lcm_wrap_types.)
find_program(LCM_GEN lcm-gen REQUIRED)

function(lcm_wrap_cpp target)
  set(out ${PROJECT_BINARY_DIR}/generated/lcmtypes)
  set(headers)
  set(includes "")
  foreach(file ${ARGN})
    file(STRINGS ${file} struct_line REGEX "^struct ")
    string(REGEX REPLACE "^struct ([A-Za-z0-9_]+).*" "\\1" name "${struct_line}")
    set(header ${out}/hydro/${name}.hpp)
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${LCM_GEN} -x --cpp-std c++11 --cpp-hpath ${out} ${CMAKE_CURRENT_SOURCE_DIR}/${file}
      COMMAND sed -i -f ${PROJECT_SOURCE_DIR}/cmake/lcm_string_length.sed ${header}
      DEPENDS ${file} ${PROJECT_SOURCE_DIR}/cmake/lcm_string_length.sed
      VERBATIM
      COMMENT "lcm-gen ${file}")
    list(APPEND headers ${header})
    string(APPEND includes "#include \"hydro/${name}.hpp\"\n")
  endforeach()
  file(CONFIGURE OUTPUT ${out}/hydro/messages.hpp CONTENT "#pragma once\n${includes}" @ONLY)
  add_custom_target(${target}_headers DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_headers)
  target_include_directories(${target} SYSTEM INTERFACE $<BUILD_INTERFACE:${out}>
                                                        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/hydro>)
  install(FILES ${headers} ${out}/hydro/messages.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hydro/hydro COMPONENT development)
  target_link_libraries(${target} INTERFACE PkgConfig::LCM)
  # The decoding is inlined into the user's code, so the user needs the option that the top CMakeLists.txt explains.
  target_compile_options(${target} INTERFACE $<INSTALL_INTERFACE:-fno-strict-aliasing>)
endfunction()
