# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D INPUT=file -D OUTPUT=file.cc -D HEADER=h -D NAMESPACE=ns -D FUNCTION=f -P embed_text.cmake
# writes a source file with  std::string_view ns::f()  that returns the bytes of INPUT.
file(READ "${INPUT}" hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
file(WRITE "${OUTPUT}"
"#include <iterator>

#include \"${HEADER}\"

namespace ${NAMESPACE} {

static constexpr unsigned char kBytes[] = {${bytes}};

std::string_view ${FUNCTION}() { return {reinterpret_cast<const char*>(kBytes), std::size(kBytes)}; }

}  // namespace ${NAMESPACE}
")
