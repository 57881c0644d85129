#include "roadbed/map/opendrive/rules/schema_table.h"

namespace roadbed::map::opendrive::rules {
namespace {

constexpr ElementText kElements[] = {
    {"OpenDRIVE", "", "header road! controller junction junctionGroup station vmsGroup@8"},
    {"header", "version@4 version:hundredths@5 north south east west",
     "offset@5- defaultRegulations@8"},
    {"offset", "x! y! z! hdg!", ""},
    {"defaultRegulations", "", "roadRegulations signalRegulations"},
    {"roadRegulations", "type:roadClass", "semantics"},
    {"signalRegulations", "", "semantics"},

    {"road", "id:text!! length>=0!!@-5 length!!@6 length>0!!@7- junction:text! rule:trafficRule*",
     "link:roadLink type:roadType planView!! elevationProfile lateralProfile lanes!! objects "
     "signals surface railroad"},
    {"roadLink", "", "predecessor:roadLinkEnd successor:roadLinkEnd neighbor@4-5"},
    {"roadLinkEnd",
     "elementType:linkedElement*!5 elementId:text! contactPoint:contact* elementS>=0@5- "
     "elementDir:direction@5 elementDir:direction@7-",
     ""},
    {"neighbor", "elementId:text! direction:sameOrOpposite! side:leftOrRight!", ""},
    {"roadType", "s>=0!! type:roadClass!! country:country@5-", "speed:roadSpeed"},
    {"roadSpeed", "max:speedLimit! unit:filled", ""},

    {"planView", "", "geometry!!"},
    {"geometry", "s>=0!! x!! y!! hdg!! length>=0!!@-5 length!!@6 length>0!!@7-",
     "line arc spiral poly3 paramPoly3"},
    {"line", "", ""},
    {"arc", "curvature!!", ""},
    {"spiral", "curvStart!! curvEnd!!", ""},
    {"poly3", "a!! b!! c!! d!!", ""},
    {"paramPoly3", "aU!! bU!! cU!! dU!! aV!! bV!! cV!! dV!! pRange:parameterRange*!", ""},

    {"elevationProfile", "", "elevation:cubic!4-5"},
    {"cubic", "s>=0!! a!! b!! c!! d!!", ""},
    {"lateralProfile", "", "superelevation:cubic crossfall@4-5 shape@4- crossSectionSurface@8"},
    {"crossfall", "side:leftRightOrBoth! s>=0! a! b! c! d!", ""},
    {"shape", "s>=0! t! a! b! c! d!", ""},
    {"crossSectionSurface", "", "tOffset:stripProfile surfaceStrips!"},
    {"surfaceStrips", "", "strip!"},
    {"strip", "id:whole mode:stripMode",
     "width:stripProfile constant:stripProfile linear:stripProfile quadratic:stripProfile "
     "cubic:stripProfile"},
    {"stripProfile", "", "coefficients!"},
    {"coefficients", "s>=0 a b c d", ""},

    {"lanes", "", "laneOffset:cubic laneSection!!"},
    {"laneSection", "s>=0!! singleSide:boolean", "left center!! right"},
    {"left", "", "lane:leftLane!4-"},
    {"center", "", "lane:centerLane!"},
    {"right", "", "lane:rightLane!4-"},
    {"leftLane",
     "id:positive!! type:laneType*!! level:level* direction:laneDirection* advisory:advisory@8 "
     "dynamicLaneDirection:boolean@8 dynamicLaneType:boolean@8 roadWorks:boolean@8",
     "link:laneLinks width:laneCubic border:laneCubic roadMark material visibility@4-5 "
     "speed:laneSpeed access height rule"},
    {"centerLane", "id:zero!! type:laneType*!5-7 level:level* direction:laneDirection*",
     "link:laneLinks width:laneCubic border:laneCubic roadMark material@6-7 speed:laneSpeed "
     "access@6-7 height@6-7 rule@6-7"},
    {"rightLane",
     "id:negative!! type:laneType*!! level:level* direction:laneDirection* advisory:advisory@8 "
     "dynamicLaneDirection:boolean@8 dynamicLaneType:boolean@8 roadWorks:boolean@8",
     "link:laneLinks width:laneCubic border:laneCubic roadMark material visibility@4-5 "
     "speed:laneSpeed access height rule"},
    {"laneLinks", "", "predecessor:linkedLane successor:linkedLane"},
    {"linkedLane", "id:whole!", ""},
    {"laneCubic", "sOffset>=0!! a!! b!! c!! d!!", ""},
    {"material", "sOffset>=0! friction>=0! roughness>=0", ""},
    {"visibility", "sOffset>=0! forward>=0! back>=0! left>=0! right>=0!", ""},
    {"laneSpeed", "sOffset>=0!! max>=0!! unit:filled", ""},
    {"access", "sOffset>=0! rule:allowOrDeny!5@5- restriction:roadUser!5-7",
     "restriction:restrictedUser@8"},
    {"restrictedUser", "type:roadUser", ""},
    {"height", "sOffset>=0! inner! outer!", ""},
    {"rule", "sOffset>=0! value:text!", ""},

    {"roadMark",
     "sOffset>=0!! type:markType!! weight:markWeight color:markColor! width>=0 "
     "laneChange:laneChange height@-6 height>0@7-",
     "type:markLines sway@5- explicit@5-"},
    {"markLines", "name:text! width>=0!@-6 width>0!@7-", "line:markLine!4-"},
    {"markLine",
     "length>=0!@-5 length:text!@6 length>=0!@7- space>=0! tOffset! sOffset>=0! rule:passing "
     "width>=0!@-5 width>0@7- color:markColor@5-",
     ""},
    {"sway", "ds>=0! a! b! c! d!", ""},
    {"explicit", "", "line:explicitLine!"},
    {"explicitLine",
     "length>=0!@5 length:text!@6 length>0!@7- tOffset! sOffset>=0! rule:passing width>=0!@5 "
     "width>0@7-",
     ""},

    {"objects", "", "object objectReference tunnel bridge"},
    {"object",
     "id:text! s>=0!! t!! zOffset! validLength>=0!5 orientation:orientation!5 type:objectType@5- "
     "length@-6 length>0@7- width radius@-6 radius>0@7- height!5@-6 height>=0@7- hdg!5 pitch!5 "
     "roll!5 dynamic:yesOrNo!5@5- perpToRoad:boolean@7-",
     "repeat outline outlines@5- material:objectMaterial validity:laneRange parkingSpace "
     "markings@5- borders@5- surface:objectSurface@7- skeleton@8"},
    {"repeat",
     "s>=0! length>=0! distance>=0! tStart! tEnd! widthStart>=0!5 widthEnd>=0!5 heightStart!@-6 "
     "heightStart>=0!@7- heightEnd!@-6 heightEnd>=0!@7- zOffsetStart! zOffsetEnd! "
     "lengthStart>=0@5- lengthEnd>=0@5- radiusStart>=0@5- radiusEnd>=0@5- "
     "detachFromReferenceLine:boolean@8",
     ""},
    {"outlines", "", "outline!"},
    {"outline",
     "id:natural!5@5- fillType:fillType!5@5- outer:boolean!5@5- closed:boolean!5@5- "
     "laneType:laneType!5@5-",
     "cornerRoad cornerLocal"},
    {"cornerRoad", "s>=0! t! dz! height!@-6 height>=0!@7- id:natural!5@5-", ""},
    {"cornerLocal", "u! v! z! height!@-6 height>=0!@7- id:natural!5@5-", ""},
    {"objectMaterial", "friction>=0 roughness>=0 roadMarkColor:markColor@8", ""},
    {"laneRange", "fromLane:whole! toLane:whole!", ""},
    {"parkingSpace", "access:parkingAccess!", "marking:parkingMarking@4"},
    {"parkingMarking", "side:boxSide type:markType width color:markColor", ""},
    {"markings", "", "marking!"},
    {"marking",
     "side:boxSide!5 weight:markWeight!5 width>=0@5 width>0@7- color:markColor! zOffset>=0 "
     "spaceLength>=0! lineLength>=0!@5 lineLength:text!@6 lineLength>0!@7- startOffset! "
     "stopOffset!",
     "cornerReference!5"},
    {"borders", "", "border:objectBorder!"},
    {"objectBorder", "width>=0! type:borderType! outlineId:natural! useCompleteOutline:boolean",
     "cornerReference!5"},
    {"cornerReference", "id:natural!", ""},
    {"objectSurface", "", "CRG:objectCrg"},
    {"objectCrg", "hideRoadSurfaceCRG:boolean zScale", ""},
    {"skeleton", "", "polyline!"},
    {"polyline", "id:positive", "vertexRoad vertexLocal"},
    {"vertexRoad", "s>=0 t dz id:positive intersectionPoint:boolean radius", ""},
    {"vertexLocal", "u v z id:positive intersectionPoint:boolean radius", ""},
    {"objectReference", "id:text! s>=0! t! zOffset!5 validLength>=0!5 orientation:orientation!",
     "validity:laneRange"},
    {"tunnel", "id:text! s>=0! length>=0! type:tunnelType! lighting:share daylight:share",
     "validity:laneRange"},
    {"bridge", "id:text! s>=0! length>=0! type:bridgeType!", "validity:laneRange"},

    {"signals", "", "signal signalReference"},
    {"signal",
     "id:text!! s>=0!! t!! dynamic:yesOrNo! orientation:orientation! zOffset!5-7 "
     "country:country@5- type:text! subtype:text! value unit:unit height>=0!5 width>=0!5 hOffset "
     "pitch roll length>=0@8",
     "validity:signalLaneRange dependency reference@5- positionInertial@5- positionRoad@5- "
     "semantics@8 staticBoard@8 vmsBoard@8"},
    {"signalLaneRange", "fromLane:whole!! toLane:whole!!", ""},
    {"dependency", "id:text!", ""},
    {"reference", "elementType:referredElement! elementId:text!", ""},
    {"positionInertial", "x! y! z! hdg! pitch roll", ""},
    {"positionRoad", "roadId:text! s>=0! t! zOffset! hOffset! pitch roll", ""},
    {"signalReference", "id:text!! s>=0!! t!! orientation:orientation!", "validity:laneRange"},
    {"staticBoard", "", "sign dependency reference validity:laneRange"},
    {"sign",
     "id:text! dynamic:yesOrNo! orientation:orientation! country:country type:text! "
     "subtype:text! value unit:unit height>=0 width>=0 length>=0 hOffset pitch roll v z",
     "validity:laneRange dependency reference positionInertial positionRoad semantics vmsBoard"},
    {"vmsBoard", "displayHeight displayWidth displayType:displayType v z",
     "displayArea dependency reference validity:laneRange"},
    {"displayArea", "index:whole v z", ""},
    {"semantics", "",
     "lane:laneMeaning priority:priorityMeaning supplementaryDistance supplementaryEnvironment "
     "supplementaryTime"},
    {"laneMeaning", "type:laneMeaning", ""},
    {"priorityMeaning", "type:priorityMeaning", ""},
    {"supplementaryDistance", "type:distanceMeaning unit:lengthUnit value", ""},
    {"supplementaryEnvironment", "type:weather", ""},
    {"supplementaryTime", "type:timeMeaning value", ""},
    {"vmsGroup", "", "vmsBoardReference!"},
    {"vmsBoardReference", "groupIndex:whole vmsIndex:whole", ""},

    {"surface", "", "CRG:roadCrg"},
    {"roadCrg",
     "file:text! sStart>=0! sEnd>=0! orientation:sameOrOpposite! mode:crgMode! sOffset tOffset "
     "zOffset zScale hOffset purpose:crgPurpose",
     ""},
    {"junctionSurface", "", "CRG:junctionCrg"},
    {"junctionCrg", "file:text! mode:junctionCrgMode! purpose:crgPurpose zOffset zScale", ""},
    {"railroad", "", "switch"},
    {"switch", "name:text! id:text! position:switchPosition!",
     "mainTrack:track!4- sideTrack:track!4- partner"},
    {"track", "id:text! s>=0! dir:direction!", ""},
    {"partner", "id:text!", ""},

    {"junction", "id:text!! type:junctionType* orientation:orientation@7- sStart>=0@7- sEnd>=0@7-",
     "connection!4-7 priority controller:junctionController surface:junctionSurface@5-7 surface@8 "
     "planView@8 objects@8 boundary@8 crossPath@8 roadSection@8"},
    {"connection",
     "id:text!! incomingRoad:text!5 connectingRoad:text!5 contactPoint:contact*!5 "
     "type:connectionType@5-",
     "laneLink predecessor:virtualEnd@5- successor:virtualEnd@5-"},
    {"laneLink", "from:whole!! to:whole!! overlapZone>0@8", ""},
    {"virtualEnd",
     "elementType:roadOnly! elementId:text! elementS>0!@-6 elementS>=0!@7- "
     "elementDir:direction!5-7",
     ""},
    {"priority", "", ""},
    {"junctionController", "id:text! sequence:natural", ""},
    {"boundary", "", "segment:boundarySegment!"},
    {"boundarySegment",
     "type:segmentType! contactPoint:contactOrStation sStart:contactOrStation "
     "sEnd:contactOrStation boundaryLane:whole jointLaneStart:whole jointLaneEnd:whole "
     "transitionLength>=0",
     ""},
    {"crossPath", "", "startLaneLink:crossedLane! endLaneLink:crossedLane!"},
    {"crossedLane", "from:whole to:whole s>=0", ""},
    {"roadSection", "sStart>=0 sEnd>=0", ""},
    {"junctionGroup", "id:text! type:junctionGroupType!", "junctionReference!4-"},
    {"junctionReference", "junction:text!", ""},
    {"controller", "id:text!! sequence:natural", "control!4-"},
    {"control", "signalId:text!!", ""},
    {"station", "name:text! id:text! type:stationType", "platform!4-"},
    {"platform", "id:text!", "segment:platformSegment!4-"},
    {"platformSegment", "roadId:text! sStart>=0! sEnd>=0! side:leftOrRight!", ""},
};

constexpr ChoiceText kChoices[] = {
    {"boolean", "true|false"},
    {"yesOrNo", "yes|no"},
    {"hundredths", "#.##"},
    {"country", "^^@6-|^^^|OpenDRIVE|Austria|Brazil|China|France|Germany|Italy|Switzerland|USA"},
    {"unit", "m|km|ft|mile|m/s|mph|km/h|kg|t|%"},
    {"lengthUnit", "m|km|ft|mile"},
    {"speedLimit", "no limit|undefined|(>=0)"},

    {"trafficRule", "RHT|LHT"},
    {"roadClass",
     "unknown|rural|motorway|town|lowSpeed|pedestrian|bicycle|townExpressway@5-|townCollector@5-|"
     "townArterial@5-|townPrivate@5-|townLocal@5-|townPlayStreet@5-"},
    {"linkedElement", "road|junction"},
    {"contact", "start|end"},
    {"contactOrStation", "start|end|(>0)"},
    {"direction", "+|-"},
    {"orientation", "+|-|none"},
    {"sameOrOpposite", "same|opposite"},
    {"leftOrRight", "left|right"},
    {"leftRightOrBoth", "left|right|both"},
    {"parameterRange", "arcLength|normalized"},
    {"stripMode", "independent|relative"},

    {"laneType",
     "none|driving|stop|shoulder|biking|sidewalk|border|restricted|parking|curb@6-|bidirectional|"
     "median|special1|special2|special3|tram|rail|roadWorks|entry|exit|offRamp|onRamp|"
     "connectingRamp@5-|bus@5-|taxi@5-|HOV@5-|mwyEntry@5-|mwyExit@5-|walking@8|slipLane@8|"
     "shared@8"},
    {"level", "true|false|1@0|0@0"},
    {"laneDirection", "standard|reversed|both"},
    {"advisory", "both|inner|none|outer"},
    {"allowOrDeny", "allow|deny"},
    {"roadUser",
     "simulator|pedestrian|none|autonomous traffic@4|autonomousTraffic@5-|passengerCar@5-|bus@5-|"
     "delivery@5-|emergency@5-|taxi@5-|throughTraffic@5-|truck@5-|bicycle@5-|motorcycle@5-|"
     "trucks@5-|HOV@8"},
    {"markType",
     "none|solid|broken|solid solid|solid broken|broken solid|broken broken|botts dots|grass|curb|"
     "custom@5-|edge@5-"},
    {"markWeight", "standard|bold"},
    {"markColor", "standard|blue|green|red|white|yellow|orange@5-|violet@7-|black@8"},
    {"laneChange", "increase|decrease|both|none"},
    {"passing", "no passing|caution|none"},

    {"objectType",
     "none|obstacle|car|pole|tree|vegetation|barrier|building|parkingSpace|patch|railing|"
     "trafficIsland|crosswalk|streetLamp|gantry|soundBarrier|truck@5|van|bus|trailer|bike|"
     "motorbike|tram|train|pedestrian|wind|roadMark@6-|roadSurface@8"},
    {"fillType", "grass|concrete|cobble|asphalt|pavement|gravel|soil|paint@8"},
    {"boxSide", "left|right|front|rear"},
    {"borderType", "concrete|curb|paint@8"},
    {"parkingAccess", "all|car|women|handicapped|bus|truck|electric|residents"},
    {"tunnelType", "standard|underpass"},
    {"bridgeType", "concrete|steel|brick|wood"},

    {"referredElement", "object|signal"},
    {"displayType",
     "LED|monochromGraphic|rotatingPrismHorizontal|rotatingPrismVertical|simpleMatrix|other"},
    {"laneMeaning",
     "noOvertakeCars|noOvertakeCarsEnd|noOvertakeTrucks|noOvertakeTrucksEnd|"
     "priorityOverOncoming|roundabout|yieldForOncoming"},
    {"priorityMeaning",
     "4way|keepClearLine|noParkingLine|noTurnOnRed|priorityRoad|priorityRoadEnd|"
     "priorityToTheRightRule|stop|stopLine|turnOnRedAllowed|trafficLight|waitingLine|yield"},
    {"distanceMeaning", "for|in"},
    {"weather", "fog|rain|snow"},
    {"timeMeaning", "day|time"},

    {"crgMode", "attached|attached0|genuine|global@5-"},
    {"junctionCrgMode", "global|attached@5-6|attached0@5-6|genuine@5-6"},
    {"crgPurpose", "elevation|friction"},
    {"switchPosition", "dynamic|straight|turn"},

    {"junctionType", "default|virtual@5-|direct@7-|crossing@8|common@0"},
    {"connectionType", "default|virtual"},
    {"roadOnly", "road"},
    {"segmentType", "joint|lane"},
    {"junctionGroupType", "roundabout|unknown|complexJunction@8|highwayInterchange@8"},
    {"stationType", "small|medium|large"},
};

}  // namespace

std::span<const ElementText> element_texts() { return kElements; }
std::span<const ChoiceText> choice_texts() { return kChoices; }

}  // namespace roadbed::map::opendrive::rules
