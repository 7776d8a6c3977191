// Stands for the headers that are precompiled (HydroLibrary.cmake): CMake wants a source.
