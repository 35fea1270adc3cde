/* ----------------------------------------------------------------------
   SPDX-License-Identifier: GPL-2.0-or-later
   Debian's liblammps-dev (29 Sep 2021) does not bring along the fmt that
   its headers include, and its own fmt is another one. What they name of
   it, never called: pass std::string to error->all.
------------------------------------------------------------------------- */

#ifndef MESOFIT_DEBIAN_FMT_H
#define MESOFIT_DEBIAN_FMT_H

#include <string>

namespace fmt {

struct string_view {
  string_view(const char *);
  string_view(const std::string &);
};

struct format_args {};

template <typename... Args, typename S> format_args make_args_checked(const S &, Args &&...);

}    // namespace fmt

#endif
