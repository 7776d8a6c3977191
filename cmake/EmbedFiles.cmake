# cmake -DOUTPUT=FILE.cc "-DFILES=NAME|PATH;..." -P EmbedFiles.cmake writes files as arrays of a C++ source
# (scope/page_files.h).
set(arrays "")
set(table "")
set(index 0)
foreach(entry ${FILES})
  string(REPLACE "|" ";" parts "${entry}")
  list(GET parts 0 name)
  list(GET parts 1 path)
  file(READ "${path}" bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char kFile${index}[] = {${bytes}0};\n")
  string(APPEND table "    {\"${name}\", kFile${index}, sizeof kFile${index} - 1},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE "${OUTPUT}" "#include \"scope/page_files.h\"\n\nnamespace hydro::scope {\nnamespace {\n${arrays}}  // namespace\n
const EmbeddedFile kPageFiles[] = {\n${table}    {nullptr, nullptr, 0}};
const unsigned long kPageFileCount = ${index};\n\n}  // namespace hydro::scope\n")
