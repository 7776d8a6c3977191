# Other middleware, if its development package is installed: libzmq3-dev with cppzmq-dev, libnng-dev,
# cyclonedds-dev. scripts/bench says how to install them. Nothing else needs them.
add_executable(bench_round_trip bench_round_trip.cc echo_lcm.cc)
target_link_libraries(bench_round_trip PRIVATE hydro_udpm hydro_pressure_app)
target_compile_definitions(bench_round_trip PRIVATE HYDRO_BENCH_CONFIG="${PROJECT_SOURCE_DIR}/config/paper.toml")

function(hydro_bench_peer name found define source)
  if(found)
    message(STATUS "bench_round_trip: beside ${name}")
    target_sources(bench_round_trip PRIVATE ${source})
    target_compile_definitions(bench_round_trip PRIVATE ${define})
    target_link_libraries(bench_round_trip PRIVATE ${ARGN})
  else()
    message(STATUS "bench_round_trip: without ${name}, which is not installed")
  endif()
endfunction()

pkg_check_modules(ZEROMQ QUIET IMPORTED_TARGET libzmq)
find_path(CPPZMQ_HEADER zmq.hpp)
if(ZEROMQ_FOUND AND CPPZMQ_HEADER)
  set(zeromq_found ON)
endif()
hydro_bench_peer("ZeroMQ" "${zeromq_found}" HYDRO_BENCH_ZEROMQ echo_zeromq.cc PkgConfig::ZEROMQ)

find_package(nng QUIET CONFIG)
hydro_bench_peer("nng" "${nng_FOUND}" HYDRO_BENCH_NNG echo_nng.cc nng::nng)

find_package(CycloneDDS QUIET CONFIG)
if(CycloneDDS_FOUND)
  enable_language(C)
  idlc_generate(TARGET hydro_bench_messages FILES echo_messages.idl)
endif()
hydro_bench_peer("Cyclone DDS" "${CycloneDDS_FOUND}" HYDRO_BENCH_CYCLONE echo_cyclone.cc CycloneDDS::ddsc hydro_bench_messages)
