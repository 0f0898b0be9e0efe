#include "app/config/config_table.h"

/* config/thesis-table.conf as it was when this was built: what a file does not say is as there. By the assembler: ISO C
 * promises no string of that length. */
__asm__(".section .rodata\n"
	".globl config_default_text\n"
	"config_default_text:\n"
	".incbin \"config/thesis-table.conf\"\n"
	".byte 0\n"
	".previous\n");
