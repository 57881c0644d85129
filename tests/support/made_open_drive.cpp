#include "roadbed/tests/support/made_open_drive.h"

#include "roadbed/map/load_map.h"

namespace roadbed::tests {

std::string curved_road_xml() {
  return R"(<?xml version="1.0"?>
<OpenDRIVE>
 <header revMajor="1" revMinor="6"><geoReference><![CDATA[+proj=utm +zone=32]]></geoReference></header>
 <road id="7" name="Bend" length="180" junction="-1">
  <type s="0" type="rural"><speed max="80" unit="km/h"/></type>
  <planView>
   <geometry s="0" x="10" y="-4" hdg="0.3" length="20"><line/></geometry>
   <geometry s="20" x="29.1067" y="1.9104" hdg="0.3" length="30"><spiral curvStart="0" curvEnd="0.04"/></geometry>
   <geometry s="50" x="54.47" y="16.51" hdg="0.9" length="40"><arc curvature="0.04"/></geometry>
   <geometry s="90" x="54.9" y="52.9" hdg="2.5" length="30"><spiral curvStart="0.04" curvEnd="-0.01"/></geometry>
   <geometry s="120" x="27.1" y="63.6" hdg="2.95" length="30"><poly3 a="0" b="0" c="0.004" d="-0.0001"/></geometry>
   <geometry s="150" x="-2.1" y="69.4" hdg="2.9" length="30"><paramPoly3 pRange="normalized"
     aU="0" bU="30" cU="0" dU="-1.2" aV="0" bV="0" cV="4" dV="-1.5"/></geometry>
  </planView>
  <elevationProfile><elevation s="0" a="100" b="0.02" c="0" d="0"/></elevationProfile>
  <lateralProfile><superelevation s="0" a="0" b="0" c="0" d="0"/>
   <superelevation s="50" a="0" b="0.001" c="0" d="0"/></lateralProfile>
  <lanes>
   <laneOffset s="0" a="0" b="0" c="0" d="0"/><laneOffset s="60" a="0" b="0" c="0.002" d="-0.00003"/>
   <laneSection s="0">
    <left><lane id="1" type="driving"><link><successor id="1"/></link>
      <width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></left>
    <center><lane id="0" type="none"><roadMark sOffset="0" type="broken"/></lane></center>
    <right><lane id="-1" type="driving"><link><successor id="-1"/></link>
      <width sOffset="0" a="3.5" b="0" c="0" d="0"/>
      <width sOffset="40" a="3.5" b="0.01" c="0.0005" d="-0.00001"/></lane>
     <lane id="-2" type="shoulder"><width sOffset="0" a="1.5" b="0" c="0" d="0"/></lane></right>
   </laneSection>
   <laneSection s="100">
    <left><lane id="1" type="driving"><link><predecessor id="1"/></link>
      <width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></left>
    <center><lane id="0" type="none"><roadMark sOffset="0" type="solid"/></lane></center>
    <right><lane id="-1" type="driving"><link><predecessor id="-1"/></link>
      <width sOffset="0" a="3.6" b="0" c="0" d="0"/></lane></right>
   </laneSection>
  </lanes>
  <signals><signal id="s1" s="30" t="-6" dynamic="no" orientation="+" country="DE" type="274"
    subtype="57" value="70" unit="km/h" zOffset="2"/></signals>
 </road>
</OpenDRIVE>
)";
}

map::RoadMap curved_two_lane_road() { return map::parse_map(curved_road_xml(), "bend.xodr"); }

}  // namespace roadbed::tests
