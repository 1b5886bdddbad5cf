# Target OpenBLAS::OpenBLAS, for this tree and for users of the installed kernels: the LAPACK of some
# baselines.
find_library(OPENBLAS_LIBRARY openblas)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  OpenBLAS REQUIRED_VARS OPENBLAS_LIBRARY
  REASON_FAILURE_MESSAGE "definite's LAPACK baselines call it: install OpenBLAS \
(libopenblas-serial-dev on Debian), or set OPENBLAS_LIBRARY")
if(OpenBLAS_FOUND AND NOT TARGET OpenBLAS::OpenBLAS)
  add_library(OpenBLAS::OpenBLAS UNKNOWN IMPORTED)
  set_target_properties(OpenBLAS::OpenBLAS PROPERTIES IMPORTED_LOCATION ${OPENBLAS_LIBRARY})
endif()
