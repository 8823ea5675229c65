/* format.cpp - compiles the part of fmt that is not in headers into the library, so that a program that links
 * Tandem::tandem needs only TBB and OpenCL. */
#include <fmt/format-inl.h>

FMT_BEGIN_NAMESPACE
namespace detail {

template auto thousands_sep_impl<char>(locale_ref) -> thousands_sep_result<char>;
template auto decimal_point_impl<char>(locale_ref) -> char;

} // namespace detail
FMT_END_NAMESPACE
