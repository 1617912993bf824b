// The contacts of spheres in single precision: the same tests, their bounds in units of the rounding.
#include "../unit/test_sphere_contact.c"
