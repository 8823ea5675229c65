/* format.cpp - the part of fmt that is no header, compiled into the library: who links Tandem::tandem needs TBB and
 * OpenCL alone. */
#include <fmt/format-inl.h>

FMT_BEGIN_NAMESPACE
namespace detail {

template auto thousands_sep_impl<char>(locale_ref) -> thousands_sep_result<char>;
template auto decimal_point_impl<char>(locale_ref) -> char;

} // namespace detail
FMT_END_NAMESPACE
