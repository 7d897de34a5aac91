// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/formula.h"

#include <fmt/core.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace kinemark::analysis {
namespace {

constexpr int kDeepestFormula = 64;
constexpr std::size_t kLongest = 2000;  // a sum of as many terms is a tree as deep

bool starts_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool goes_on(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

Formula call(std::string name, std::vector<Formula> arguments) {
  Formula out{.kind = Formula::Kind::call};
  out.name = std::move(name);
  out.arguments = std::move(arguments);
  return out;
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Result<Formula> whole() {
    auto out = sum(0);
    if (out && peek() != '\0') return wrong("the end or an operator");
    return out;
  }

 private:
  // Next letter that is no blank; 0 at the end.
  char peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  std::unexpected<Error> wrong(std::string_view expected) {
    const char next = peek();
    return fail(Code::bad_input,
                fmt::format("column {} of '{}': {}; expected {}", at_ + 1, text_,
                            next == '\0' ? std::string("it ends") : fmt::format("'{}'", next), expected));
  }

  Result<Formula> chain(int depth, char one, char other, Result<Formula> (Parser::*inner)(int)) {
    auto left = (this->*inner)(depth);
    while (left) {
      const char next = peek();
      if (next != one && next != other) break;
      ++at_;
      auto right = (this->*inner)(depth);
      if (!right) return right;
      std::vector<Formula> both;
      both.push_back(std::move(*left));
      both.push_back(std::move(*right));
      left = call(std::string(1, next), std::move(both));
    }
    return left;
  }
  Result<Formula> sum(int depth) { return chain(depth, '+', '-', &Parser::product); }
  Result<Formula> product(int depth) { return chain(depth, '*', '/', &Parser::sign); }
  Result<Formula> sign(int depth) {
    if (depth > kDeepestFormula) return wrong("at most 64 levels of brackets and signs");
    const char next = peek();
    if (next != '-' && next != '+') return factor(depth);
    ++at_;
    auto inner = sign(depth + 1);
    if (!inner || next == '+') return inner;
    std::vector<Formula> one;
    one.push_back(std::move(*inner));
    return call("neg", std::move(one));
  }
  Result<Formula> factor(int depth) {
    const char next = peek();
    if (next == '(') {
      ++at_;
      auto inner = sum(depth + 1);
      if (!inner) return inner;
      if (peek() != ')') return wrong("')'");
      ++at_;
      return inner;
    }
    if (next == '\'') return quoted();
    if (starts_name(next)) return named(depth);
    return number();
  }
  Result<Formula> quoted() {
    const auto end = text_.find('\'', at_ + 1);
    if (end == std::string_view::npos || end == at_ + 1) return wrong("a name between quotes");
    Formula out{.kind = Formula::Kind::name};
    out.name = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return out;
  }
  std::string word() {
    const auto begin = at_;
    while (at_ < text_.size() && goes_on(text_[at_])) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }
  Result<Formula> named(int depth) {
    Formula out{.kind = Formula::Kind::name};
    out.name = word();
    const char next = peek();
    if (next == '.') {
      ++at_;
      out.part = word();
      if (out.part != "x" && out.part != "y" && out.part != "z" && out.part != "o")
        return wrong("x, y, z or o behind the point");
      return out;
    }
    if (next != '(') return out;
    ++at_;
    out.kind = Formula::Kind::call;
    if (peek() == ')') {
      ++at_;
      return out;
    }
    while (true) {
      auto argument = sum(depth + 1);
      if (!argument) return argument;
      out.arguments.push_back(std::move(*argument));
      const char then = peek();
      if (then != ',' && then != ')') return wrong("',' or ')'");
      ++at_;
      if (then == ')') return out;
    }
  }
  Result<Formula> number() {
    Formula out;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), out.value);
    if (error != std::errc() || !std::isfinite(out.value)) return wrong("a number, a name or '('");
    at_ = static_cast<std::size_t>(end - text_.data());
    return out;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Result<Formula> parse_formula(std::string_view text) {
  if (text.size() > kLongest)
    return fail(Code::bad_input,
                fmt::format("a formula of {} letters; expected {} at most", text.size(), kLongest));
  return Parser(text).whole();
}

}  // namespace kinemark::analysis
