/* newton_record.h - what is recorded and counted; nothing here decides.
 */
#ifndef ELASTO_NEWTON_RECORD_H
#define ELASTO_NEWTON_RECORD_H

#include "solve/newton.h"

/* Shows the record to the observer.  Returns its status, or INTERRUPTED where
 * the observer asks to stop. */
Status newton_tell(Newton *newton, const NewtonRecord *record);

#endif
