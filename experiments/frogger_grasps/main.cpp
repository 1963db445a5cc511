#include <cstdio>
#include <ctime>
#include <algorithm>
#include "experiments/frogger_grasps/reference_grasps.hpp"
#include "experiments/frogger_grasps/frogger_setting.hpp"
#include "grasp/precision_search.hpp"
#include "grasp/quality.hpp"
#include "robot/load_robot.hpp"
using namespace opponens;
static double cpu(){timespec t;clock_gettime(CLOCK_PROCESS_CPUTIME_ID,&t);return t.tv_sec+1e-9*t.tv_nsec;}
static double med(std::vector<double> v){std::sort(v.begin(),v.end());return v.empty()?0:v[v.size()/2];}
int main(int argc,char**argv){
 robot::RobotModel hand(robot::load_hand("/work/wt/precision/experiments/frogger_grasps/allegro_simplified.yaml"));
 int seeds=atoi(argv[1]); int enough=atoi(argv[2]); int maxev=atoi(argv[3]); int model=atoi(argv[4]);int draws=atoi(argv[5]);
 for(int a=6;a<argc;++a){
  ReferenceFile f=read_reference(std::string("/work/shared/reference/frogger/")+argv[a]+".frogger.json");
  auto scene=frogger_scene("/work/shared/data/objects/ycb/"+f.object+"/"+f.object+".obj",f.table_z,true);
  double t0=cpu();
  auto target=grasp::make_target(scene,"object",1);
  SynergyBox box=frogger_joint_box(hand);
  auto surface=grasp::hand_surface(hand,box.center);
  auto checkers=grasp::hand_checkers(hand,scene,"object");
  grasp::PrecisionSettings s; s.count=1; s.enough=enough; s.max_trials=100; s.max_evaluations=maxev; s.draws=draws;
  s.tips=model?grasp::TipModel::fixed_point:grasp::TipModel::ball;
  s.max_penetration=model?0.003:0.001;
  auto space=grasp::make_precision_space(hand,surface,target,box,s.tips,frogger_convention(f.mu,f.edges),s.goal,s.max_penetration);
  double t1=cpu();
  std::vector<double> tl,te,ol,oe,ot,tt; 
  for(auto&g:f.valid){Posture p; p.X_OH.linear()=tangent_rotation()*g.X_OB.linear();p.X_OH.translation()=tangent_rotation()*g.X_OB.translation();p.q=g.q;
    auto q=grasp::evaluate(tip_contacts(hand,surface,target,grasp::TipModel::fixed_point,p,NormalRule::distance,f.mu),frogger_convention(f.mu,f.edges));
    tl.push_back(q.min_weight.value_or(-1));te.push_back(q.epsilon.value_or(-1));tt.push_back(g.seconds);}
  std::map<std::string,long> rej; long trials=0,ev=0; int none=0;
  for(int seed=1;seed<=seeds;++seed){
    double c=cpu();
    auto r=grasp::search_precision_grasps({space,s,checkers,"free",nullptr},seed);
    ot.push_back(cpu()-c);
    trials+=r.trials;ev+=r.evaluations; for(auto&k:r.rejected)rej[k.first]+=k.second;
    if(r.grasps.empty()){none++;ol.push_back(0);oe.push_back(0);continue;}
    ol.push_back(r.grasps[0].quality.min_weight.value_or(0));oe.push_back(*r.grasps[0].quality.epsilon);
  }
  printf("%-22s setup %.2f theirs l %.4f eps %.5f t %.2f | ours l %.4f eps %.5f t %.3f none %d trials %ld ev %ld |",argv[a],t1-t0,med(tl),med(te),med(tt),med(ol),med(oe),med(ot),none,trials,ev);
  for(auto&k:rej)printf(" %s:%ld",k.first.c_str(),k.second);
  printf("\n");fflush(stdout);
 }
}
