/* kernel_range.h - turns a shared function of one item into a function over a range.
 *
 * The argument types are read from the shared function itself, so kernels.def needs none. Included
 * inside the namespace of a width, after its shared headers.
 */
#pragma once

template <class T> static inline T argument_as(void *pointer)
{
  if constexpr (std::is_pointer_v<T>) return static_cast<T>(pointer);
  else return *static_cast<const T *>(pointer);
}

template <class T> struct Signature;
template <class... Arguments> struct Signature<void (*)(Arguments...)> {
  static constexpr size_t count = sizeof...(Arguments);
  template <size_t k> using type = std::tuple_element_t<k, std::tuple<Arguments...>>;
};

template <auto function, class Body, size_t... k>
static inline void with_arguments(void *const *arguments, Body body, std::index_sequence<k...>)
{
  using Types = Signature<decltype(function)>;
  body(argument_as<typename Types::template type<k>>(arguments[k])...);
}

/* The last parameter of an item function is the item. */
template <auto function> static void run_items(void *const *arguments, uint32_t first, uint32_t last)
{
  constexpr size_t count = Signature<decltype(function)>::count - 1;
  with_arguments<function>(
      arguments,
      [&](auto... bound) {
#ifdef TANDEM_LANES
        for (uint32_t i = first; i < last; i += TANDEM_LANES) function(bound..., item_index{i});
#else
        for (uint32_t i = first; i < last; ++i) function(bound..., i);
#endif
      },
      std::make_index_sequence<count>{});
}

/* The last two parameters of a group function are its local memory and its number. */
template <auto function> static void run_groups(void *const *arguments, uint32_t first, uint32_t last)
{
  constexpr size_t count = Signature<decltype(function)>::count - 2;
  alignas(64) uint local_memory[LOCAL_WORDS * sizeof(memory_real) / sizeof(float)];
  with_arguments<function>(
      arguments,
      [&](auto... bound) {
        for (uint32_t group = first; group < last; ++group) function(bound..., local_memory, group);
      },
      std::make_index_sequence<count>{});
}
