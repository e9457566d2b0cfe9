// The registry of contact methods.
#include "contact/method.hpp"

namespace ogive {

#define OGIVE_DECLARE(method) extern const ContactMethodDef method##_method;
OGIVE_CONTACT_METHODS(OGIVE_DECLARE)
#undef OGIVE_DECLARE

namespace {

const ContactMethodDef* const methods[] = {
#define OGIVE_LIST(method) &method##_method,
    OGIVE_CONTACT_METHODS(OGIVE_LIST)
#undef OGIVE_LIST
};

}  // namespace

int contact_method_count() { return static_cast<int>(sizeof methods / sizeof methods[0]); }

const ContactMethodDef& contact_method(ContactMethod method) { return *methods[static_cast<int>(method)]; }

}  // namespace ogive
