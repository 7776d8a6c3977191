# Compiling several sources of a library as one: what they include is read once, a third less work for a build of everything.
# Who edits one file compiles its whole group again, so the preset for development does without.
option(HYDRO_COMPILE_TOGETHER "Compile groups of sources as one: faster for all, slower for one" OFF)

# hydro_compile_together(TARGET FILES...): one group; names in the files' unnamed namespaces must differ. A file in no group is
# compiled alone, as those should be that take long by themselves (Eigen's decompositions).
function(hydro_compile_together target)
  if(NOT HYDRO_COMPILE_TOGETHER)
    return()
  endif()
  list(GET ARGN 0 group)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${group})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
