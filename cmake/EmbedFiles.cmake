# cmake -DOUT=demo_files.cpp -DROOT=examples -DNAMESPACE=knotwave::demo -DHEADER=demo/demo.h -DFILES="a;b" -P EmbedFiles.cmake
# Writes a C++ source that holds the files byte for byte, under their names relative to ROOT. HEADER has
# struct EmbeddedFile and embedded_files().
set(arrays "")
set(table "")
set(number 0)
foreach(file IN LISTS FILES)
  file(READ ${file} hex HEX)
  file(RELATIVE_PATH name ${ROOT} ${file})
  string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND arrays "constexpr unsigned char kFile${number}[] = {\n${bytes}0};\n")
  string(APPEND table "    {\"${name}\", {kFile${number}, sizeof kFile${number} - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUT} "// Made by cmake/EmbedFiles.cmake from examples/.
#include \"${HEADER}\"

namespace ${NAMESPACE} {
namespace {
${arrays}constexpr EmbeddedFile kFiles[] = {
${table}};
}  // namespace

std::span<const EmbeddedFile> embedded_files() { return kFiles; }

}  // namespace ${NAMESPACE}
")
