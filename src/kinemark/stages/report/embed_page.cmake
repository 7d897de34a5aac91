# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D INPUT=report.html -D OUTPUT=page_template.cc -P embed_page.cmake: a file as an array of bytes.
file(READ "${INPUT}" hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
file(WRITE "${OUTPUT}"
"#include <iterator>

#include \"kinemark/stages/report/internal/page.h\"

namespace kinemark::report::internal {

static constexpr unsigned char kPage[] = {${bytes}};

std::string_view page_template() { return {reinterpret_cast<const char*>(kPage), std::size(kPage)}; }

}  // namespace kinemark::report::internal
")
