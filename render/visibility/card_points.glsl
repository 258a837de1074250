// Buffers of card_points.h, by binding.
#define CARD_BACK       0x80000000u
#define CARD_TRANSMITS  0x80000000u // of a triangle: light comes through it
#define CARD_POSITIONS  0
#define CARD_NORMALS    1
#define CARD_FACTS      2
#define CARD_PROBES     3
#define CARD_CORNERS    4
#define CARD_SIDES      5
#define CARD_MARKS      6
#define CARD_LIST       7
#define CARD_WORK       8
#define CARD_ORIGINS    9
#define CARD_DIRECTIONS 10
#define CARD_VALUES     11
#define CARD_TREE       12
#define CARD_HOLES      14

// Words of the work buffer: how many probes are listed; dispatches of 64 a group, and of as many by four regions.
#define CARD_LISTED      0
#define CARD_GROUPS      4
#define CARD_BY_REGIONS  8
#define CARD_WORK_WORDS  12
