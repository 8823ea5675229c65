# absent.sh - what a script says when a device is missing: CTest shows status 77 as skipped; where CI=true nothing may
# be left out.
absent() { # NAME
  if [ "${CI:-}" = true ]; then
    echo "no $1, which CI=true requires"
    exit 1
  fi
  echo "skipped: no $1"
  exit 77
}
