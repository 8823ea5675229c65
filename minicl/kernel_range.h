/* kernel_range.h - turns a shared function of one item into a function over a range.
 *
 * The argument types are deduced from the shared function itself, so the tables need none. The file is included inside
 * the namespace of a width, after its shared headers.
 */
#pragma once

/* An argument is a buffer, a value of 4 bytes, or a struct of buffers (shared/argument_groups.h), which takes one
 * pointer for each of its buffers. */
template <class T> static inline T argument_as(void *const *arguments)
{
  if constexpr (std::is_pointer_v<T>) return static_cast<T>(arguments[0]);
  else if constexpr (!std::is_class_v<T>) return *static_cast<const T *>(arguments[0]);
  else {
    T group;
    __builtin_memcpy(&group, arguments, sizeof group);
    return group;
  }
}

template <class T> static constexpr size_t arguments_of = std::is_class_v<T> ? sizeof(T) / sizeof(void *) : 1;

template <class T> struct Signature;
template <class... Arguments> struct Signature<void (*)(Arguments...)> {
  static constexpr size_t count = sizeof...(Arguments);
  template <size_t k> using type = std::tuple_element_t<k, std::tuple<Arguments...>>;
  static constexpr size_t place_of(size_t k)
  {
    const size_t sizes[] = {arguments_of<Arguments>...};
    size_t place = 0;
    for (size_t i = 0; i < k; ++i) place += sizes[i];
    return place;
  }
};

template <auto function, class Body, size_t... k>
static inline void with_arguments(void *const *arguments, Body body, std::index_sequence<k...>)
{
  using Types = Signature<decltype(function)>;
  body(argument_as<typename Types::template type<k>>(arguments + Types::place_of(k))...);
}

/* The last parameter of an item function is the index of the item. */
template <auto function>
static __attribute__((noinline)) void run_items(void *const *arguments, uint32_t first, uint32_t last)
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

#ifdef TANDEM_LANES
template <auto function>
static __attribute__((noinline)) void run_any_items(void *const *arguments, uint32_t first, uint32_t last)
{
  constexpr size_t count = Signature<decltype(function)>::count - 1;
  with_arguments<function>(
      arguments,
      [&](auto... bound) {
        for (; last - first > TANDEM_LANES; first += TANDEM_LANES) function(bound..., item_index{first, TANDEM_LANES});
        function(bound..., item_index{first, last - first});
      },
      std::make_index_sequence<count>{});
}

/* The same with any number of items. To ask at each load whether items fill the lanes costs a twentieth, so whole
 * instructions have code of their own. A few of them do not: the 50 kB of a solver would have to come to the caches for
 * each, and for what is left again. */
template <auto function> static void run_padded_items(void *const *arguments, uint32_t first, uint32_t last)
{
  constexpr uint32_t few = 8 * TANDEM_LANES;
  const uint32_t left = last - first < few ? first : last - (last - first) % TANDEM_LANES;
  if (first < left) run_items<function>(arguments, first, left);
  if (left < last) run_any_items<function>(arguments, left, last);
}
#endif

/* The last two parameters of a group function are its local memory and its index. */
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
